// Writes pose samples to their topics, in the caller's thread. The sink's thread is its only user.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "platform/dds/frame_transforms.hpp"
#include "platform/dds/messages.hpp"
#include "platform/dds/participant.hpp"
#include "platform/dds/topic_names.hpp"

namespace glint {

// What diagnostics tell beside each tool's state.
struct SinkFigures {
  std::uint64_t offered = 0;
  std::uint64_t written = 0;
  std::uint64_t ring_dropped = 0;
};

class PosePublisher {
 public:
  // Joins the domain, creates every writer and writes tf_static. Throws as Participant does, and
  // InputError for tools that are none, too many, or alike once named for ROS.
  explicit PosePublisher(const DdsSettings& settings);

  // Poses and transforms that DDS refused so far.
  [[nodiscard]] std::uint64_t others_failed() const { return others_failed_; }

  // How many readers the tool's status topic has found, the smallest over all tools.
  [[nodiscard]] int readers() const;

  // For readers of the same process; a domain is opened once.
  [[nodiscard]] const std::shared_ptr<Participant>& participant() const { return participant_; }

  // The status, and where there is a pose the pose, its covariance and tf. False: DDS did not take
  // the status, or the tick does not follow the tool's last one; then nothing is written.
  bool write(const PoseSample& sample);

  // tf: world to the camera and to a robot on a body, where the head's pose is known.
  void write_frame(const FrameTransforms& frame);

  // tf_static: world to the robot, from now on; the other transforms as they were.
  void write_robot(const Pose& T_world_robot);

  void write_diagnostics(const SinkFigures& figures);

  // Marks the end of every tool's stream and waits for the readers' receipts.
  void end_streams(Duration limit);

 private:
  struct ToolStream {
    std::string name;
    ToolTopics topics;
    dds_entity_t status = 0, pose = 0, pose_covariance = 0, pose_systematic = 0;
    bool started = false;
    Time start;         // board time of the first tick
    Time newest;        // of the newest tick, written or not
    Time last_written;  // one period before the start until one is written
    std::uint64_t ticks_not_sent = 0;
    PoseSample sample;  // the newest
  };

  bool write_status(ToolStream& stream, Time tick, StatusMessage message);
  void write_pose(const ToolStream& stream, const PoseSample& sample);
  void write_other(dds_entity_t writer, const void* message);
  void write_static_transforms();
  [[nodiscard]] Time unix_time(Time board) const { return board + settings_.unix_minus_board; }
  [[nodiscard]] const char* frame_name(ReferenceFrame frame) const;

  DdsSettings settings_;
  std::shared_ptr<Participant> participant_;
  std::vector<ToolStream> streams_;
  std::uint64_t others_failed_ = 0;
  dds_entity_t tf_ = 0, tf_static_ = 0, diagnostics_ = 0;
};

}  // namespace glint
