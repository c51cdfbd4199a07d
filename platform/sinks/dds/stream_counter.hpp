// Counts received and missed messages of one tool's stream, from gaps in the tick stamps. Ticks for
// which the sink wrote nothing (ring full, output skipped) are not transport losses: the sink
// states them in ticks_not_sent, and they are subtracted.
#pragma once

#include <cstdint>

#include "platform/sinks/dds/tick_gap.hpp"

namespace glint {

struct StreamMark {
  Time stamp;
  Time stream_start;
  Duration tick_period;
  std::uint64_t ticks_not_sent = 0;
};

class StreamCounter {
 public:
  void add(const StreamMark& mark) {
    if (advance(mark)) ++received_;
  }
  // The end mark is one period after the last tick and is not counted.
  void end(const StreamMark& mark) { ended_ = advance(mark) || ended_; }

  [[nodiscard]] std::uint64_t received() const { return received_; }
  [[nodiscard]] std::uint64_t missed() const { return missed_; }
  [[nodiscard]] bool ended() const { return ended_; }

 private:
  // Returns false for a stamp that is not after the last one: it was counted already.
  bool advance(const StreamMark& mark) {
    if (mark.tick_period.nanoseconds <= 0) return false;
    if (!started_ || mark.stream_start != start_) {  // a restarted sink begins a new stream
      started_ = true;
      start_ = mark.stream_start;
      last_ = mark.stream_start - mark.tick_period;
      not_sent_ = 0;
    }
    const std::int64_t ticks = ticks_between(last_, mark.stamp, mark.tick_period);
    const auto not_sent = static_cast<std::int64_t>(mark.ticks_not_sent - not_sent_);
    if (ticks < 1 || not_sent < 0 || not_sent >= ticks) return false;
    missed_ += static_cast<std::uint64_t>(ticks - 1 - not_sent);
    last_ = mark.stamp;
    not_sent_ = mark.ticks_not_sent;
    return true;
  }

  bool started_ = false, ended_ = false;
  Time start_, last_;
  std::uint64_t not_sent_ = 0, received_ = 0, missed_ = 0;
};

}  // namespace glint
