// Writes pose samples to their topics of the DDS process. Only the sink's thread uses it.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "platform/sinks/dds/dds_process.hpp"
#include "platform/sinks/dds/frame_transforms.hpp"
#include "platform/sinks/dds/messages.hpp"
#include "platform/sinks/dds/topic_names.hpp"

namespace glint {

// Counts in the diagnostics of each tool.
struct SinkCounts {
  std::uint64_t offered = 0;
  std::uint64_t written = 0;
  std::uint64_t ring_dropped = 0;
};

// Messages that the DDS process took. Lost: not published.
struct ProcessCounts {
  std::uint64_t statuses = 0, poses = 0;  // published
  std::uint64_t statuses_lost = 0;
  std::uint64_t others_lost = 0;
};

class PosePublisher {
 public:
  // Joins the domain, creates every writer and writes tf_static. Throws as DdsProcess::of, and
  // InputError if there are no tools, too many, or two with the same ROS name.
  explicit PosePublisher(const DdsSettings& settings);
  ~PosePublisher();  // removes the writers
  PosePublisher(const PosePublisher&) = delete;
  PosePublisher& operator=(const PosePublisher&) = delete;

  // Number of poses and transforms that the DDS process did not take.
  [[nodiscard]] std::uint64_t others_failed() const { return others_failed_; }
  [[nodiscard]] ProcessCounts process_counts() const;

  // Number of readers of the tools' status topics; the minimum over all tools.
  [[nodiscard]] int readers() const;

  [[nodiscard]] const std::shared_ptr<DdsProcess>& process() const { return process_; }

  // Writes the status and, if there is a pose, the pose, its covariances and tf. Returns false if
  // the DDS process does not take the status or if the tick is not after the tool's last one; then
  // writes nothing.
  bool write(const PoseSample& sample);

  // tf: from world to the camera, and to a robot on the reference body; only with a valid head
  // pose.
  void write_frame(const FrameTransforms& frame);

  // tf_static: replaces the transform from world to the robot; keeps all others.
  void write_robot(const Pose& T_world_robot);

  void write_diagnostics(const SinkCounts& counts);

  // Waits for the readers' acknowledgements. After that process_counts() has every message.
  void flush(Duration limit) { process_->flush(limit); }

  // Marks the end of every tool's stream, which process_counts() includes, and flushes.
  void end_streams(Duration limit);

 private:
  struct ToolStream {
    std::string name;
    ToolTopics topics;
    int status = 0, pose = 0, pose_covariance = 0, pose_systematic = 0;  // writers
    bool started = false;
    Time start;         // session time of the first tick
    Time newest;        // of the newest tick, written or not
    Time last_written;  // before the first: one period before the start
    std::uint64_t ticks_not_sent = 0;
    PoseSample sample;  // the newest
  };

  bool write_status(ToolStream& stream, Time tick, StatusMessage message);
  void write_pose(const ToolStream& stream, const PoseSample& sample);
  void write_unreliable(int writer, const void* message);
  void write_static_transforms();
  [[nodiscard]] std::vector<int> writers() const;
  [[nodiscard]] Time unix_time(Time board) const { return board + settings_.unix_minus_session; }
  [[nodiscard]] const char* frame_name(ReferenceFrame frame) const;

  DdsSettings settings_;
  std::shared_ptr<DdsProcess> process_;
  std::vector<ToolStream> streams_;
  std::uint64_t others_failed_ = 0;
  int tf_ = 0, tf_static_ = 0, diagnostics_ = 0;
  std::optional<int> description_;      // writer of robot_description
  std::uint64_t faults_published_ = 0;  // of a live source
};

}  // namespace glint
