// Frame to CAN: from a frame's last byte in memory to the return of the write of the CAN frame that
// first carries its estimate; three parts that add up to it exactly.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "kernels/units.hpp"

namespace glint {

struct FrameToCan {
  Duration computing;  // arrival -> estimate published
  Duration sampling;   // published -> the tick that reads it has woken
  Duration sending;    // that -> its first CAN frame is written
  [[nodiscard]] Duration total() const { return computing + sampling + sending; }
};

// What was observed, never a bound.
struct LatencyFigures {
  std::int64_t n = 0;
  double p50_us = 0, p99_us = 0, p99_9_us = 0, max_us = 0;
};

// Room for a run is set aside at the start; what does not fit is counted, never allocated.
class LatencyLog {
 public:
  explicit LatencyLog(std::size_t capacity) { entries_.reserve(capacity); }
  void add(const FrameToCan& entry) noexcept {
    if (entries_.size() < entries_.capacity()) {
      entries_.push_back(entry);
    } else {
      ++beyond_;
    }
  }
  [[nodiscard]] const std::vector<FrameToCan>& entries() const { return entries_; }
  [[nodiscard]] std::int64_t beyond() const { return beyond_; }

 private:
  std::vector<FrameToCan> entries_;
  std::int64_t beyond_ = 0;
};

// Nearest-rank percentiles of one part, e.g. &FrameToCan::computing, or of the totals.
[[nodiscard]] LatencyFigures figures_of(const std::vector<FrameToCan>& entries,
                                        Duration FrameToCan::*part);
[[nodiscard]] LatencyFigures figures_of_totals(const std::vector<FrameToCan>& entries);

}  // namespace glint
