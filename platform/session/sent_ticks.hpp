// Counts the ticks whose pose frames have left over CAN: their states, gaps and latencies.
//
// A log's writer runs behind the ticks and may fail later: a tick is pending until the sink reports
// its frames as sent. Memory is fixed; no heap after the start.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "kernels/limits.hpp"
#include "kernels/units.hpp"
#include "kernels/wire/pose_sample.hpp"
#include "platform/session/latency.hpp"

namespace glint {

// One tick whose pose frames the sink accepted, at least some of them.
struct TickOfFrames {
  std::uint64_t last = 0;  // frames accepted up to its last pose frame
  Time at;                 // send time of its first frame
  int tools = 0;
  bool whole = false;    // no frame of a pose was refused
  bool carries = false;  // the first tick that carries a frame's estimate
  std::array<TrackState, k_tools_max> states{};
  FrameToCan latency;  // where it carries one
};

// The ticks of one tool that left, by state.
struct ToolTicks {
  std::uint64_t measured = 0, predicted = 0, lost = 0;
  std::uint64_t none = 0;                // nothing was measured since the start
  Duration longest_without_measurement;  // between ticks that left as measured, and to either end
  Time last_measured;                    // or the first that left

  [[nodiscard]] std::uint64_t all() const { return measured + predicted + lost + none; }
};

// What a run reports of them.
struct TicksLeft {
  std::uint64_t ticks = 0;  // all of whose pose frames left
  Duration longest_gap;     // between two of these
  std::array<ToolTicks, k_tools_max> tools{};

  [[nodiscard]] bool any_measured() const {
    return std::any_of(tools.begin(), tools.end(),
                       [](const ToolTicks& tool) { return tool.measured > 0; });
  }
};

class SentTicks {
 public:
  // `latencies`: how many there is room for.
  explicit SentTicks(std::size_t latencies);

  // Counts what has left by now, then takes one more tick. `sent`: CanSinkCounts::sent.
  void add(const TickOfFrames& tick, std::uint64_t sent) noexcept;
  // Counts what has left by now.
  void settle(std::uint64_t sent) noexcept;

  [[nodiscard]] const LatencyLog& latencies() const noexcept { return latencies_; }
  [[nodiscard]] const TicksLeft& left() const noexcept { return left_; }

 private:
  void count(const TickOfFrames& tick) noexcept;

  std::vector<TickOfFrames> pending_;  // a ring
  std::uint64_t pushed_ = 0, popped_ = 0;
  LatencyLog latencies_;
  TicksLeft left_;
  Time last_;
};

}  // namespace glint
