// Tick group of a run: at each tick computes pose samples and CAN frames from the newest estimates.
// Sends the frames at once; passes samples to DDS, to the recorder and to the output hash.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>

#include "graph/rate_group.hpp"
#include "nodes/output.hpp"
#include "platform/cells/cell.hpp"
#include "platform/runtime/session/file_sink.hpp"
#include "platform/runtime/session/frame_group.hpp"
#include "platform/runtime/session/frame_source.hpp"
#include "platform/runtime/session/loss_watch.hpp"
#include "platform/runtime/session/sent_ticks.hpp"
#include "platform/sinks/can/can_sink.hpp"
#include "platform/sinks/dds/pose_output.hpp"
#include "platform/sinks/headset/headset_output.hpp"
#include "platform/sinks/record/recorder.hpp"
#include "platform/sinks/record/sha256.hpp"

namespace glint {

extern template class GroupRunner<Output>;  // in tick_group.cpp, once

// Outputs of the tick group; each may be null.
struct TickSinks {
  CanSink* can = nullptr;
  PoseOutput* dds = nullptr;
  FileSink* files = nullptr;
  RecorderLane* lane = nullptr;
  const Recorder* recorder = nullptr;  // of the lane
  LossCounters* losses = nullptr;      // counts of losses
  // Called with each output record; a replay compares it.
  std::function<void(std::span<const std::uint8_t>)> record{};
  HeadsetOutput* headset = nullptr;
  PoseOutput* openigtlink = nullptr;
};

class TickGroup {
 public:
  TickGroup(const Cell& cell, graph::TripleBuffer<Estimates>& estimates,
            graph::TripleBuffer<RobotFrame>& robot, graph::TripleBuffer<PenButtons>& buttons,
            Clock now, TickSinks sinks, std::int64_t unix_offset_ns, std::size_t latency_entries,
            GroupRunner<Output>& runner, OverrunNotes& frame_notes);

  // Runs tick `number` at its nominal time; `woken`: actual start. After an overrun the policy's
  // substitute is sent.
  void tick(std::uint64_t number, Time nominal, Time woken) noexcept;
  // Replay. release_as() takes the versions that the recorded tick read; returns false if one was
  // not published. tick_as() runs the tick, with the recorded decision instead of the clock's.
  [[nodiscard]] bool release_as(const ChoiceRecord& recorded) noexcept;
  void tick_as(std::uint64_t number, const ChoiceRecord& recorded) noexcept;
  // While not enabled, each tick sends `stop_safe` and the heartbeat "stopped". From any thread.
  void enable(bool enabled) noexcept { enabled_ = enabled; }
  // Call when no tick can follow: sends the heartbeat "stopped".
  void stop_safe() noexcept;

  // From now on counts the ticks without a measurement while this source is late, and notes its
  // silences.
  void watch(FrameSource& source) noexcept { source_ = &source; }

  // Call after the last tick. Flushes the CAN sink first.
  [[nodiscard]] const SentTicks& sent() noexcept;
  // Ticks without a measurement of any tool while the source was late.
  [[nodiscard]] std::uint64_t ticks_source_late() const noexcept { return ticks_source_late_; }
  [[nodiscard]] std::uint64_t can_frames() const noexcept { return can_frames_; }
  [[nodiscard]] std::uint64_t records() const noexcept { return records_; }
  // Samples of the last tick; none if it was skipped.
  [[nodiscard]] const PoseSamples& samples() const noexcept { return *samples_; }
  // Hash of all output records so far, lower-case hex.
  [[nodiscard]] std::string output_sha256() const;

 private:
  void run(const Now& now, Time woken, const graph::OverrunDecision* recorded) noexcept;
  void compute_substitute(const Now& now) noexcept;
  void send(const Now& now, Time woken) noexcept;
  void send_poses(Time woken) noexcept;
  [[nodiscard]] CanFrame with_node_state(const CanFrame& frame) const noexcept;
  void send_emergency(Time tick) noexcept;
  [[nodiscard]] std::uint64_t carried_sequence() const noexcept;
  bool send_one(const CanFrame& frame, Time time) noexcept;
  void send_alone(const CanFrame& frame) noexcept;
  [[nodiscard]] std::size_t pose_frames() const noexcept;
  [[nodiscard]] bool lacks_measurement() const noexcept;
  void offer_samples() noexcept;

  std::unique_ptr<Output> output_ = std::make_unique<Output>();
  graph::RateGroup<Output> group_;
  Clock now_;
  TickSinks sinks_;
  GroupRunner<Output>* runner_;
  OverrunNotes* frame_notes_;
  OverrunNotes own_notes_;
  unsigned node_;
  int frames_a_pose_;
  TickRelease tick_release_;
  Duration lost_after_;
  graph::OverrunDecision overrun_;  // of the last tick
  bool skipped_ = false;            // no output at the last tick
  const PoseSamples* samples_;
  const CanFrames* frames_;
  std::unique_ptr<PoseSamples> in_time_ = std::make_unique<PoseSamples>();
  std::unique_ptr<PoseSamples> substitute_ = std::make_unique<PoseSamples>();
  std::unique_ptr<CanFrames> substitute_frames_ = std::make_unique<CanFrames>();
  std::int64_t unix_offset_ns_;
  LossMonitor losses_;
  SentTicks sent_;
  std::atomic<bool> enabled_{true};
  FrameSource* source_ = nullptr;
  std::uint64_t ticks_source_late_ = 0;
  Sha256 hash_;
  std::uint64_t carried_version_ = 0;  // of the newest estimates that CAN has carried
  std::uint64_t can_frames_ = 0, can_accepted_ = 0;
  std::uint64_t records_ = 0;
};

}  // namespace glint
