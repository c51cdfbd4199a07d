// DDS publisher of pose samples, for ROS 2 and other readers, on a thread of its own behind a
// bounded ring. The participant lives in the DDS process (dds_process.hpp).
//
// The tick thread only copies a sample into the ring: no heap, no lock, no system call. The sink's
// thread polls the ring every poll_period; a wake-up would cost the tick thread a system call.
// Samples that the full ring rejects are counted. A sample is written when the DDS process has
// published its status. After stop(), offered = written + ring_dropped holds exactly. Topics, types
// and the reader's counting: README.md.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <thread>

#include "graph/latest.hpp"
#include "graph/ring.hpp"
#include "kernels/wire/pose_sample.hpp"
#include "platform/runtime/rt/source_faults.hpp"
#include "platform/sinks/dds/dds_settings.hpp"
#include "platform/sinks/dds/frame_transforms.hpp"
#include "platform/sinks/dds/pose_output.hpp"

namespace glint {

class DdsProcess;
class PosePublisher;

struct DdsCounts {
  std::uint64_t offered = 0;        // calls of offer()
  std::uint64_t written = 0;        // of these, written to the tool's status topic
  std::uint64_t ring_dropped = 0;   // not written: ring full, unknown tool, stopped, and the next 2
  std::uint64_t write_failed = 0;   // not taken by the DDS process, or out of tick order
  std::uint64_t process_lost = 0;   // taken by the DDS process, not published
  std::uint64_t poses_written = 0;  // poses of written samples
  std::uint64_t poses_and_transforms_lost =
      0;  // all other messages: ring full, not taken or not published by the DDS process
  std::uint64_t process_restarts = 0;
  [[nodiscard]] std::uint64_t lost() const { return ring_dropped + poses_and_transforms_lost; }
};

class DdsSink final : public PoseOutput {
 public:
  static constexpr int k_ring_capacity = 1024;  // 4 s of one tool at 250 Hz
  static constexpr int k_frame_capacity = 64;   // 1.4 s of frames

  // Joins the domain. Throws MissingDevice if the network interface does not exist or has no IPv4
  // address; InputError if a setting is out of range or this process has opened the domain with
  // another configuration.
  explicit DdsSink(const DdsSettings& settings);
  ~DdsSink() override;  // stop()
  DdsSink(const DdsSink&) = delete;
  DdsSink& operator=(const DdsSink&) = delete;

  // Before start() the ring only fills.
  void start();

  // Returns whether `count` readers discovered every tool's status topic within `limit`. A reader
  // does not receive samples written before its discovery.
  [[nodiscard]] bool wait_for_readers(int count, Duration limit) const;

  bool offer(const PoseSample& sample) noexcept override;
  bool offer_frame(const FrameTransforms& frame) noexcept override { return frames_.push(frame); }

  // Call from one other thread only: the newest pose of the followed robot, for tf_static.
  void offer_robot(const Pose& T_world_robot) noexcept {
    robot_.write_slot() = T_world_robot;
    robot_.publish(++robot_version_, 0);
  }

  // The DDS process, for readers of this program; empty after stop().
  [[nodiscard]] std::shared_ptr<DdsProcess> process() const;

  // Writes the contents of the ring, sends the end of the streams, waits for acknowledgements (at
  // most 2 s) and leaves the domain. Call after the offering thread has ended.
  void stop();

  // Thread-safe. The identity above holds after stop().
  [[nodiscard]] DdsCounts counts() const noexcept;
  [[nodiscard]] std::uint64_t lost() const noexcept override { return counts().lost(); }

 private:
  void run();
  void write_queued();
  void write_diagnostics();
  void note_process_counts();

  using Counter = std::atomic<std::uint64_t>;
  graph::Ring<PoseSample, k_ring_capacity> ring_;
  graph::Ring<FrameTransforms, k_frame_capacity> frames_;
  graph::TripleBuffer<Pose> robot_;
  std::uint64_t robot_version_ = 0;
  Counter offered_{0}, refused_{0}, written_{0}, write_failed_{0}, poses_written_{0};
  Counter others_failed_{0}, process_lost_{0}, restarts_{0};
  std::atomic<bool> accepting_{true};
  std::atomic<bool> stopping_{false};
  int tool_count_;
  Duration poll_period_;
  const SourceFaults* source_;
  std::unique_ptr<PosePublisher> publisher_;
  std::thread thread_;
};

}  // namespace glint
