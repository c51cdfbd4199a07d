// Release times of the ticks: by the clock, and by frames' estimates if the cell selects so.
//
// An estimate with a measured tool releases a tick at its publication, but not before the shortest
// gap (5/8 of the period) after the last tick. Between estimates the clock releases the ticks, at
// most one period apart. Their gaps are chosen so that the last tick precedes the next expected
// estimate by 3/4 of the period: then the estimate releases its tick at once, from 1/8 of a period
// before its expected time to 1/4 after it.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>

#include "nodes/tokens.hpp"
#include "platform/cells/cell.hpp"
#include "platform/runtime/rt/release.hpp"

namespace glint {

// Whether the frame of these estimates measured a tool, if only by one or two markers.
[[nodiscard]] inline bool has_measurement(const Estimates& estimates) noexcept {
  const std::uint64_t frame = estimates.verdict.stamp.sequence;
  return estimates.verdict.usable() &&
         std::any_of(estimates.tracks.begin(), estimates.tracks.begin() + estimates.tool_count,
                     [frame](const Track& track) {
                       return track.alive && !track.unconfirmed && track.frame_sequence == frame;
                     });
}

// Newest published estimate that contains a measured tool.
struct MeasuredEstimate {
  std::uint64_t version = 0;  // 0: none yet
  Time published;
};

// Passes it from the frame thread to the tick thread.
class MeasuredEstimates {
 public:
  // Frame thread, after the estimate is published.
  void publish(const MeasuredEstimate& estimate) noexcept {
    published_ns_.store(estimate.published.nanoseconds, std::memory_order_relaxed);
    version_.store(estimate.version, std::memory_order_release);
    published_.post();
  }
  // Tick thread. If the frame thread publishes meanwhile, the time may be the newer one.
  [[nodiscard]] MeasuredEstimate newest() const noexcept {
    const std::uint64_t version = version_.load(std::memory_order_acquire);
    return {version, {published_ns_.load(std::memory_order_relaxed)}};
  }
  // Tick thread: waits for a publication since the last call; false: `deadline` (monotonic) passed.
  [[nodiscard]] bool wait_until(Time deadline) noexcept { return published_.wait_until(deadline); }

 private:
  std::atomic<std::uint64_t> version_{0};
  std::atomic<std::int64_t> published_ns_{0};
  Release published_;
};

class TickReleases {
 public:
  explicit TickReleases(const Cell& cell)
      : by_estimates_(cell.tick_release == TickRelease::estimate),
        period_(tick_period_of(cell)),
        shortest_(shortest_tick_gap_of(cell)),
        frame_period_(cell.camera.period),
        last_(Time{} - period_),
        gap_(period_) {}

  // Next release, in session time; the first one is at its start.
  [[nodiscard]] Time next(const MeasuredEstimate& newest) const noexcept {
    const Time by_clock = last_ + gap_;
    if (!by_estimates_ || newest.version == carried_.version) return by_clock;
    return std::min(by_clock, std::max(newest.published, last_ + shortest_));
  }

  // Call after next(), with the same estimate.
  void released(Time nominal, const MeasuredEstimate& newest) noexcept {
    last_ = nominal;
    carried_ = newest;
    gap_ = by_estimates_ && carried_.version > 0 ? gap_before(next_estimate()) : period_;
  }

 private:
  // Expected publication after the last tick; frames may be lost.
  [[nodiscard]] Time next_estimate() const noexcept {
    const std::int64_t since = (last_ - carried_.published).nanoseconds;
    return carried_.published + frame_period_ * (since / frame_period_.nanoseconds + 1);
  }

  [[nodiscard]] Duration gap_before(Time estimate) const noexcept {
    const Duration remaining = estimate - last_;
    if (remaining <= period_) return period_;  // the estimate is expected before the clock's tick
    const std::int64_t paced_ns = (remaining - Duration{period_.nanoseconds * 3 / 4}).nanoseconds;
    const std::int64_t gaps = (paced_ns + period_.nanoseconds - 1) / period_.nanoseconds;
    return std::max(Duration{paced_ns / gaps}, shortest_);
  }

  bool by_estimates_;
  Duration period_, shortest_, frame_period_;
  Time last_;
  Duration gap_;
  MeasuredEstimate carried_;
};

}  // namespace glint
