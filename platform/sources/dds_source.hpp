// Live source of frames over DDS, as published by ROS 2 camera drivers: an image topic each for
// reflectivity and depth, CameraInfo, and the head pose by tf or a PoseStamped topic. The DDS
// process receives them; a thread with default scheduling reads them as bytes; RosFrames converts
// them to frames. A queue holds at most k_image_queue_size images of each topic.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include "platform/sinks/dds/dds_process.hpp"
#include "platform/sources/live_source.hpp"
#include "platform/sources/ros_frames.hpp"

namespace glint {

class DdsSource final : public LiveSource {
 public:
  // Requires `cell.source` of kind dds. Waits for a CameraInfo if the cell names no lens. Throws
  // InputError for an empty or invalid topic, and as DdsProcess::of does; MissingDevice if no
  // CameraInfo arrives.
  [[nodiscard]] static std::unique_ptr<DdsSource> open(Cell& cell, LiveSettings live);
  ~DdsSource() override;
  DdsSource(const DdsSource&) = delete;
  DdsSource& operator=(const DdsSource&) = delete;

  [[nodiscard]] SourceReport report() override;

 private:
  enum class Use : std::uint8_t { reflectivity, depth, pose, moving_transforms, fixed_transforms };
  // A subscribed topic.
  struct Input {
    Use use;
    std::string topic;
    int reader = 0;
  };
  DdsSource(std::shared_ptr<DdsProcess> process, const Cell& cell, LiveSettings live);
  void add(Use use, const std::string& topic, bool reliable);
  void run() noexcept;
  [[nodiscard]] bool take(const Input& input);
  void use(const Input& input, std::span<const std::uint8_t> message, std::uint64_t publisher);
  void stop();

  std::shared_ptr<DdsProcess> process_;
  SourceSettings source_;
  int domain_;
  RosFrames frames_;
  std::vector<Input> inputs_;
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

}  // namespace glint
