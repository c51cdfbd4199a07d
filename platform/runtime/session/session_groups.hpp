// Groups of a run, their data exchange, execution, monitoring and outputs. Common to all runs: live
// or in order, on a desktop or a companion computer.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "platform/runtime/rt/trace_writer.hpp"
#include "platform/runtime/session/accuracy.hpp"
#include "platform/runtime/session/background_group.hpp"
#include "platform/runtime/session/calibration_watch.hpp"
#include "platform/runtime/session/decision_hash.hpp"
#include "platform/runtime/session/frame_group.hpp"
#include "platform/runtime/session/session.hpp"
#include "platform/runtime/session/sinks.hpp"
#include "platform/runtime/session/tick_group.hpp"
#include "platform/runtime/session/tool_roster.hpp"

namespace glint {

// Number of frames whose results are kept.
struct KeptFrames {
  std::size_t latencies = 0;  // 0: unknown number; keeps the newest
  std::size_t outcomes = 0;   // for comparison with ground truth
};

class SessionGroups {
 public:
  // `trace` may be null and must not be started yet.
  SessionGroups(const Cell& cell, const SessionOptions& options, KeptFrames kept, Sinks& sinks,
                TraceWriter* trace, const Clock& now, std::int64_t unix_offset_ns,
                BackgroundScene scene);

  void process(const ArrivedFrame& arrived) noexcept;                  // frame thread
  void tick(std::uint64_t number, Time nominal, Time woken) noexcept;  // tick thread
  void enable(bool enabled) noexcept { tick_.enable(enabled); }        // see TickGroup
  // Call instead of the next tick: see TickGroup.
  void stop_safe() noexcept { tick_.stop_safe(); }

  // Applies scheduled and requested changes up to `now`. Do not call on a real-time thread.
  void apply_changes(Time now) {
    roster_.apply_changes(now);
    calibration_.review(now, *calibration_notes_);
  }

  // Null if the cell has none.
  [[nodiscard]] BackgroundGroup* background() noexcept { return background_.get(); }

  [[nodiscard]] const BackgroundGroup* background() const noexcept { return background_.get(); }

  // See TickGroup.
  void watch(FrameSource& source) noexcept { tick_.watch(source); }

  // Estimates that release a tick, if the cell selects so.
  [[nodiscard]] MeasuredEstimates& measured() noexcept { return measured_; }

  // Call after all groups have ended.
  void report(SessionResult& result);

 private:
  GroupRunner<Tracker> frame_runner_;
  GroupRunner<Output> tick_runner_;
  std::unique_ptr<BackgroundGroup> background_;
  OverrunCounters* counters_;
  ToolRoster roster_;
  graph::TripleBuffer<RobotFrame> robot_;
  MeasuredEstimates measured_;
  FrameGroup frame_;
  TickGroup tick_;
  DecisionHash decisions_;
  CalibrationMonitor calibration_;
  CalibrationFindingsStore* calibration_notes_;
  std::vector<FrameOutcome> outcomes_;
  std::size_t processed_ = 0, tracked_ = 0;
};

// The two loops of a run.
//
// Live: frames on arrival, ticks and slices by the clock from `epoch` on, each group in a thread of
// its own. Ticks continue until the last frame's poses are lost, or until the run is stopped.
void run_live(const Cell& cell, Time epoch, FrameSource& source, SessionGroups& groups,
              const SessionOptions& options, SessionResult& result);

// In order: frames, ticks and slices in the order of their nominal times, in one thread.
// Deterministic: the same bytes in every run. `now` is the groups' clock.
void run_in_order(const Cell& cell, Time& now, FrameSource& source, SessionGroups& groups,
                  const SessionOptions& options, SessionResult& result);

// First line of the trace file.
[[nodiscard]] std::string trace_header(const Cell& cell, const RunSchedule& plan,
                                       std::int64_t epoch_unix_ns);

}  // namespace glint
