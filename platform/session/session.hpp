// One run of Glint, from frames to CAN, DDS and a recording, in real time or as fast as can be.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "platform/cells/cell.hpp"
#include "platform/session/accuracy.hpp"
#include "platform/session/latency.hpp"
#include "platform/session/sink_outcome.hpp"

namespace glint {

struct SessionOptions : SinkOptions {
  std::function<void(double done_s, double all_s)> progress;
  const std::atomic<bool>* stop = nullptr;  // set: the run ends here, whole as far as it went
};

struct SessionResult : SinkOutcome {
  Accuracy accuracy;
  std::vector<FrameToCan> latencies;
  std::int64_t frames = 0;
  std::int64_t ticks = 0;
  std::int64_t ticks_late = 0, ticks_skipped = 0;
  std::int64_t late_renders = 0;
  double duration_s = 0;
  std::uint64_t heap_allocations_after_start = 0;
  bool heap_counted = false;
  std::uint64_t worker_overruns = 0;
  std::uint64_t can_frames = 0;
};

// On simulated frames: of the scenario that the cell asks for, or of one's own (its camera is the
// cell's). Throws InputError, MissingDevice.
[[nodiscard]] SessionResult run_session(const Cell& cell, const SessionOptions& options);
[[nodiscard]] SessionResult run_session(const Cell& cell, sim::Scenario scenario,
                                        const SessionOptions& options);

}  // namespace glint
