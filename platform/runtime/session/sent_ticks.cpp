#include "platform/runtime/session/sent_ticks.hpp"

#include <algorithm>

#include "platform/sinks/can/can_sink.hpp"

namespace glint {

// Each tick has at least one frame, so there are at most as many ticks as frames in flight.
SentTicks::SentTicks(std::size_t latencies)
    : pending_(k_can_in_flight_max), latencies_(latencies) {}

void SentTicks::add(const TickOfFrames& tick, std::uint64_t sent) noexcept {
  settle(sent);
  // Full: the sink has failed permanently, and no later frame leaves.
  if (pushed_ - popped_ == pending_.size()) return;
  pending_[pushed_++ % pending_.size()] = tick;
}

void SentTicks::settle(std::uint64_t sent) noexcept {
  while (popped_ < pushed_) {
    const TickOfFrames& tick = pending_[popped_ % pending_.size()];
    if (tick.last > sent) return;
    count(tick);
    ++popped_;
  }
}

void SentTicks::count(const TickOfFrames& tick) noexcept {
  if (tick.carries) latencies_.add(tick.latency);
  if (!tick.all_accepted) return;
  if (summary_.ticks++ > 0) summary_.longest_gap = std::max(summary_.longest_gap, tick.at - last_);
  last_ = tick.at;
  for (int t = 0; t < tick.tools; ++t) {
    ToolTicks& tool = summary_.tools[static_cast<std::size_t>(t)];
    const TrackState state = tick.states[static_cast<std::size_t>(t)];
    if (tool.all() == 0) tool.last_measured = tick.at;
    tool.longest_without_measurement =
        std::max(tool.longest_without_measurement, tick.at - tool.last_measured);
    if (state == TrackState::measured) tool.last_measured = tick.at;
    ++(state == TrackState::measured    ? tool.measured
       : state == TrackState::predicted ? tool.predicted
       : state == TrackState::lost      ? tool.lost
                                        : tool.none);
  }
}

}  // namespace glint
