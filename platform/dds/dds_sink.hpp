// Poses to ROS 2 and any other DDS reader, from a thread of its own behind a bounded ring.
//
// The tick thread only copies a sample into the ring: no heap, no lock, no system call. The sink's
// thread looks into the ring every poll_period; waking it instead would cost the tick thread a
// system call. What the ring cannot hold is counted, and after stop() offered = written +
// ring_dropped holds exactly. Topics, types and the reader's counting: README.md.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <thread>

#include "graph/latest.hpp"
#include "graph/ring.hpp"
#include "kernels/wire/pose_sample.hpp"
#include "platform/dds/dds_settings.hpp"
#include "platform/dds/frame_transforms.hpp"

namespace glint {

class Participant;
class PosePublisher;

struct DdsCounts {
  std::uint64_t offered = 0;        // samples given to offer()
  std::uint64_t written = 0;        // of these, written to the tool's status topic
  std::uint64_t ring_dropped = 0;   // of these, not: ring full, unknown tool, stopped, not written
  std::uint64_t write_failed = 0;   // the part of ring_dropped that DDS or the tick order refused
  std::uint64_t poses_written = 0;  // written samples that had a pose
  std::uint64_t others_lost = 0;    // poses and transforms: no room, or refused by DDS
  [[nodiscard]] std::uint64_t lost() const { return ring_dropped + others_lost; }
};

class DdsSink {
 public:
  static constexpr int k_ring_capacity = 1024;  // 4 s of one tool at 250 Hz
  static constexpr int k_frame_capacity = 64;   // 1.4 s of frames

  // Joins the domain. Throws MissingDevice when the network interface is not there or has no IPv4
  // address, InputError when a setting is out of range or the domain is already open in this
  // process.
  explicit DdsSink(const DdsSettings& settings);
  ~DdsSink();  // stop()
  DdsSink(const DdsSink&) = delete;
  DdsSink& operator=(const DdsSink&) = delete;

  // Until then the ring only fills.
  void start();

  // Whether `count` readers have found every tool's status topic before the limit is over. Samples
  // written before a reader has found the topic never reach it.
  [[nodiscard]] bool wait_for_readers(int count, Duration limit) const;

  // From one thread only. False: the sample was dropped and counted. A tool's ticks must advance.
  bool offer(const PoseSample& sample) noexcept;

  // From one other thread only: what a frame tells tf. False: no room; it is counted.
  bool offer_frame(const FrameTransforms& frame) noexcept { return frames_.push(frame); }

  // From one other thread only: where a robot that is followed now stands, for tf_static. Only the
  // newest counts.
  void offer_robot(const Pose& T_world_robot) noexcept {
    robot_.write_slot() = T_world_robot;
    robot_.publish(++robot_version_, 0);
  }

  // The domain's participant, for readers of this process; empty after stop(). A reader that holds
  // it keeps the domain open.
  [[nodiscard]] std::shared_ptr<Participant> participant() const;

  // Writes what is in the ring, tells readers that the stream ends, waits for their receipts (at
  // most 2 s) and leaves the domain. Call it when the offering thread has ended.
  void stop();

  // From any thread; the identity holds after stop().
  [[nodiscard]] DdsCounts counts() const noexcept;

 private:
  void run();
  void write_waiting();
  void write_diagnostics();

  using Counter = std::atomic<std::uint64_t>;
  graph::Ring<PoseSample, k_ring_capacity> ring_;
  graph::Ring<FrameTransforms, k_frame_capacity> frames_;
  graph::TripleBuffer<Pose> robot_;
  std::uint64_t robot_version_ = 0;
  Counter offered_{0}, refused_{0}, written_{0}, write_failed_{0}, poses_written_{0};
  Counter others_failed_{0};
  std::atomic<bool> accepting_{true};
  std::atomic<bool> stopping_{false};
  int tool_count_;
  Duration poll_period_;
  std::unique_ptr<PosePublisher> publisher_;
  std::thread thread_;
};

}  // namespace glint
