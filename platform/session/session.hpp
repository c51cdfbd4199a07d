// One run of Glint, from frames to CAN, DDS and a recording, in real time or as fast as can be.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "platform/cells/cell.hpp"
#include "platform/rt/machine_check.hpp"
#include "platform/session/accuracy.hpp"
#include "platform/session/background_group.hpp"
#include "platform/session/group_runner.hpp"
#include "platform/session/latency.hpp"
#include "platform/session/run_plan.hpp"
#include "platform/session/sent_ticks.hpp"
#include "platform/session/sink_outcome.hpp"

namespace glint {

struct SessionOptions : SinkOptions {
  std::function<void(double done_s, double all_s)> progress;
  std::function<void(int rendered, int wanted)> rendering;  // frames, before the start
  Duration source_frame_time;  // the source needs so long for each frame: a slow one, for tests
  const std::atomic<bool>* stop = nullptr;  // set: the run ends here, whole as far as it went
  RunPlan plan;                             // who runs what, and the bounds; made without a board
  std::vector<Injection> injections;        // delays, to see what is done about them
  bool trace = false;                       // trace.spans in `out`
  std::optional<int> keys;                  // a terminal whose keys are buttons: KeyTerminal's
};

struct SessionResult : SinkOutcome {
  Accuracy accuracy;
  std::vector<FrameOutcome> outcomes;  // one for each frame delivered
  std::vector<FrameToCan> latencies;
  TicksLeft sent;                       // the ticks that left over CAN
  std::uint64_t ticks_source_late = 0;  // without a measurement, while the source was late
  std::int64_t frames = 0;
  std::int64_t ticks = 0;
  std::int64_t ticks_late = 0, ticks_skipped = 0;
  std::int64_t late_renders = 0;
  double duration_s = 0;  // of the session's clock, to the last tick
  std::uint64_t heap_allocations_after_start = 0;
  bool heap_counted = false;
  std::uint64_t worker_overruns = 0;  // waits for another worker beyond some milliseconds
  OverrunCounts frame_overruns, tick_overruns;
  std::optional<BackgroundCounts> background;  // where the cell has one
  std::uint64_t page_faults_after_start = 0;   // of the frame and tick threads
  MachineCheck machine;                        // what spoils a live run's timing
  std::uint64_t trace_spans = 0, trace_dropped = 0;
  std::uint64_t can_frames = 0;
  std::uint64_t key_events = 0;  // buttons that keys stood for
};

// On simulated frames: of the scenario that the cell asks for, or of one's own (its camera is the
// cell's). Throws InputError, MissingDevice.
[[nodiscard]] SessionResult run_session(const Cell& cell, const SessionOptions& options);
[[nodiscard]] SessionResult run_session(const Cell& cell, sim::Scenario scenario,
                                        const SessionOptions& options);

}  // namespace glint
