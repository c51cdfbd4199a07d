// Live frames over DDS as ROS 2's camera drivers publish them: an image topic each for reflectivity
// and depth, CameraInfo, and the head pose by tf or a PoseStamped topic. A thread with the usual
// scheduling takes the messages as bytes; RosFrames makes frames of them.
//
// Cyclone takes heap for what it receives, in its own threads, and k_images_kept images of each
// topic wait in it at most.
#pragma once

#include <dds/dds.h>

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <span>
#include <string>
#include <thread>

#include "platform/dds/participant.hpp"
#include "platform/rt/release.hpp"
#include "platform/sources/live_source.hpp"
#include "platform/sources/ros_frames.hpp"

namespace glint {

class DdsSource final : public LiveSource {
 public:
  // `cell.source`: dds. Waits for a CameraInfo where the cell names no lens. Throws InputError for
  // a topic that has no name, and as Participant does; MissingDevice: no CameraInfo.
  [[nodiscard]] static std::unique_ptr<DdsSource> open(Cell& cell, LiveSettings live);
  ~DdsSource() override;
  DdsSource(const DdsSource&) = delete;
  DdsSource& operator=(const DdsSource&) = delete;

  [[nodiscard]] SourceReport report() override;

 private:
  enum class Use : std::uint8_t { reflectivity, depth, pose, moving_transforms, fixed_transforms };
  // A topic that is read.
  struct Input {
    Input(Use is_for, Release& posts) : use(is_for), is_there(posts) {}
    Use use;
    Release& is_there;
    dds_entity_t reader = 0;
    std::atomic<int> waiting{0};  // messages in the reader
    std::atomic<std::uint64_t> overwritten{0};
    std::string topic;
  };
  DdsSource(std::shared_ptr<Participant> participant, const Cell& cell, LiveSettings live);
  void add(Use use, const std::string& topic, bool reliable);
  static void on_message(dds_entity_t reader, void* input) noexcept;
  void run() noexcept;
  [[nodiscard]] bool take(Input& input);
  void use(const Input& input, std::span<const std::uint8_t> message, std::uint64_t publisher);
  void stop();

  std::shared_ptr<Participant> participant_;
  SourceSettings source_;
  int domain_;
  RosFrames frames_;
  Release is_there_;
  std::deque<Input> inputs_;
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

}  // namespace glint
