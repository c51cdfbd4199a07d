// Writes pose samples to their DDS topics, synchronously. Only the sink's thread uses it.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "platform/sinks/dds/frame_transforms.hpp"
#include "platform/sinks/dds/messages.hpp"
#include "platform/sinks/dds/participant.hpp"
#include "platform/sinks/dds/topic_names.hpp"

namespace glint {

// Counts in the diagnostics of each tool.
struct SinkCounts {
  std::uint64_t offered = 0;
  std::uint64_t written = 0;
  std::uint64_t ring_dropped = 0;
};

class PosePublisher {
 public:
  // Joins the domain, creates every writer and writes tf_static. Throws as Participant, and
  // InputError if there are no tools, too many, or two with the same ROS name.
  explicit PosePublisher(const DdsSettings& settings);

  // Number of poses and transforms that DDS rejected.
  [[nodiscard]] std::uint64_t others_failed() const { return others_failed_; }

  // Number of readers of the tools' status topics; the minimum over all tools.
  [[nodiscard]] int readers() const;

  // For readers of the same process, which open a domain once.
  [[nodiscard]] const std::shared_ptr<Participant>& participant() const { return participant_; }

  // Writes the status and, if there is a pose, the pose, its covariances and tf. Returns false if
  // DDS rejects the status or if the tick is not after the tool's last one; then writes nothing.
  bool write(const PoseSample& sample);

  // tf: from world to the camera, and to a robot on the reference body; only with a valid head
  // pose.
  void write_frame(const FrameTransforms& frame);

  // tf_static: replaces the transform from world to the robot; keeps all others.
  void write_robot(const Pose& T_world_robot);

  void write_diagnostics(const SinkCounts& counts);

  // Marks the end of every tool's stream and waits for the readers' acknowledgements.
  void end_streams(Duration limit);

 private:
  struct ToolStream {
    std::string name;
    ToolTopics topics;
    dds_entity_t status = 0, pose = 0, pose_covariance = 0, pose_systematic = 0;
    bool started = false;
    Time start;         // session time of the first tick
    Time newest;        // of the newest tick, written or not
    Time last_written;  // before the first: one period before the start
    std::uint64_t ticks_not_sent = 0;
    PoseSample sample;  // the newest
  };

  bool write_status(ToolStream& stream, Time tick, StatusMessage message);
  void write_pose(const ToolStream& stream, const PoseSample& sample);
  void write_unreliable(dds_entity_t writer, const void* message);
  void write_static_transforms();
  [[nodiscard]] Time unix_time(Time board) const { return board + settings_.unix_minus_session; }
  [[nodiscard]] const char* frame_name(ReferenceFrame frame) const;

  DdsSettings settings_;
  std::shared_ptr<Participant> participant_;
  std::vector<ToolStream> streams_;
  std::uint64_t others_failed_ = 0;
  dds_entity_t tf_ = 0, tf_static_ = 0, diagnostics_ = 0;
  std::uint64_t faults_published_ = 0;  // of a live source
};

}  // namespace glint
