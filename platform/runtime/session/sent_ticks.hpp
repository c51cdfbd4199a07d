// Counts the ticks whose pose frames have left over CAN: their states, gaps and latencies.
//
// A log's writer is asynchronous and may fail later. A tick is pending until the sink reports its
// frames as sent. Memory is fixed; no heap after the start.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "kernels/limits.hpp"
#include "kernels/units.hpp"
#include "kernels/wire/pose_sample.hpp"
#include "platform/runtime/session/latency.hpp"

namespace glint {

// A tick of which the sink accepted at least one pose frame.
struct TickOfFrames {
  std::uint64_t last = 0;  // frames accepted up to its last pose frame
  Time at;                 // send time of its first frame
  int tools = 0;
  bool all_accepted = false;  // all pose frames were accepted
  bool carries = false;       // the first tick that carries a frame's estimate
  std::array<TrackState, k_tools_max> states{};
  FrameToCan latency;  // if `carries`
};

// Number of sent ticks of one tool, by state.
struct ToolTicks {
  std::uint64_t measured = 0, predicted = 0, lost = 0;
  std::uint64_t none = 0;                // no measurement since the start
  Duration longest_without_measurement;  // between measured ticks, and to the first and last tick
  Time last_measured;                    // or the first sent tick

  [[nodiscard]] std::uint64_t all() const { return measured + predicted + lost + none; }
};

// Summary for the run's report.
struct SentTicksSummary {
  std::uint64_t ticks = 0;  // with all pose frames sent
  Duration longest_gap;     // between two of these ticks
  std::array<ToolTicks, k_tools_max> tools{};

  [[nodiscard]] bool any_measured() const {
    return std::any_of(tools.begin(), tools.end(),
                       [](const ToolTicks& tool) { return tool.measured > 0; });
  }
};

class SentTicks {
 public:
  // `latencies`: capacity of the latency log.
  explicit SentTicks(std::size_t latencies);

  // Counts the pending ticks sent so far, then adds `tick`. `sent`: CanSinkCounts::sent.
  void add(const TickOfFrames& tick, std::uint64_t sent) noexcept;
  // Counts the pending ticks sent so far.
  void settle(std::uint64_t sent) noexcept;

  [[nodiscard]] const LatencyLog& latencies() const noexcept { return latencies_; }
  [[nodiscard]] const SentTicksSummary& summary() const noexcept { return summary_; }

 private:
  void count(const TickOfFrames& tick) noexcept;

  std::vector<TickOfFrames> pending_;  // a ring
  std::uint64_t pushed_ = 0, popped_ = 0;
  LatencyLog latencies_;
  SentTicksSummary summary_;
  Time last_;
};

}  // namespace glint
