// Frame to CAN: from a frame's last byte in memory to the return of the write of the CAN frame that
// first carries its estimate; three parts that add up to it exactly.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "kernels/units.hpp"

namespace glint {

struct FrameToCan {
  Duration computing;  // arrival -> estimate published
  Duration sampling;   // published -> the tick that reads it has woken
  Duration sending;    // that -> its first CAN frame is written
  [[nodiscard]] constexpr Duration total() const { return computing + sampling + sending; }
};

// What was observed, never a bound.
struct LatencyFigures {
  std::int64_t n = 0;
  double p50_us = 0, p99_us = 0, p99_9_us = 0, max_us = 0;
};

constexpr std::int64_t size_of(const FrameToCan& entry) { return entry.total().nanoseconds; }
constexpr std::int64_t size_of(std::int64_t nanoseconds) { return nanoseconds; }

// The newest entries of a run that may have no end, and the largest of all. The room is set aside
// at the start; adding takes nothing from the heap.
template <class Entry>
class NewestLog {
 public:
  // Hours of a camera, 17 minutes of ticks at 250 Hz.
  static constexpr std::size_t k_entries_max = std::size_t{1} << 18;

  explicit NewestLog(std::size_t capacity)
      : capacity_(std::clamp<std::size_t>(capacity, 2, k_entries_max)) {
    entries_.reserve(capacity_);
  }
  void add(const Entry& entry) noexcept {
    std::size_t at = entries_.size();
    if (at < capacity_) {
      entries_.push_back(entry);
    } else {
      if (next_ == largest_) next_ = (next_ + 1) % capacity_;
      at = next_;
      entries_[at] = entry;
      next_ = (next_ + 1) % capacity_;
      ++left_out_;
    }
    if (size_of(entry) > size_of(entries_[largest_])) largest_ = at;
  }
  // In no order beyond the first `capacity`.
  [[nodiscard]] const std::vector<Entry>& entries() const { return entries_; }
  // Older ones that made room.
  [[nodiscard]] std::int64_t left_out() const { return left_out_; }

 private:
  std::size_t capacity_;
  std::vector<Entry> entries_;
  std::size_t next_ = 0, largest_ = 0;
  std::int64_t left_out_ = 0;
};

using LatencyLog = NewestLog<FrameToCan>;
using WakeUpLog = NewestLog<std::int64_t>;

// Nearest-rank percentiles of one part, e.g. &FrameToCan::computing, or of the totals.
[[nodiscard]] LatencyFigures figures_of(const std::vector<FrameToCan>& entries,
                                        Duration FrameToCan::*part);
[[nodiscard]] LatencyFigures figures_of_totals(const std::vector<FrameToCan>& entries);

}  // namespace glint
