// Live source of frames over DDS, as published by ROS 2 camera drivers: an image topic each for
// reflectivity and depth, CameraInfo, and the head pose by tf or a PoseStamped topic. A thread with
// default scheduling receives the messages as bytes; RosFrames converts them to frames.
//
// Cyclone allocates heap for received messages, in its own threads. Its queue holds at most
// k_image_queue_size images of each topic.
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

#include "platform/runtime/rt/release.hpp"
#include "platform/sinks/dds/participant.hpp"
#include "platform/sources/live_source.hpp"
#include "platform/sources/ros_frames.hpp"

namespace glint {

class DdsSource final : public LiveSource {
 public:
  // Requires `cell.source` of kind dds. Waits for a CameraInfo if the cell names no lens. Throws
  // InputError for an empty or invalid topic, and as Participant does; MissingDevice if no
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
    Input(Use is_for, Release& posts) : use(is_for), has_message(posts) {}
    Use use;
    Release& has_message;
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
  Release has_message_;
  std::deque<Input> inputs_;
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

}  // namespace glint
