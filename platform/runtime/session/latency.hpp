// Frame-to-CAN latency: from a frame's last byte in memory to the return of the write of the first
// CAN frame that carries its estimate. Its three parts add up exactly.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "kernels/units.hpp"

namespace glint {

struct FrameToCan {
  Duration computing;  // arrival to publication of the estimate
  Duration sampling;   // publication to the wake-up of the tick that reads it
  Duration sending;    // wake-up to the end of the write of its first CAN frame
  [[nodiscard]] constexpr Duration total() const { return computing + sampling + sending; }
};

// Observed values, not bounds.
struct LatencyFigures {
  std::int64_t n = 0;
  double p50_us = 0, p99_us = 0, p99_9_us = 0, max_us = 0;
};

constexpr std::int64_t size_of(const FrameToCan& entry) { return entry.total().nanoseconds; }
constexpr std::int64_t size_of(std::int64_t nanoseconds) { return nanoseconds; }

// Ring of the newest entries of a run of unknown length, and the largest of all. Allocates at
// construction only.
template <class Entry>
class NewestLog {
 public:
  // Hours of camera frames; 17 minutes of ticks at 250 Hz.
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
      ++overwritten_;
    }
    if (size_of(entry) > size_of(entries_[largest_])) largest_ = at;
  }
  // Unordered beyond the first `capacity`.
  [[nodiscard]] const std::vector<Entry>& entries() const { return entries_; }
  // Number of older entries that were overwritten.
  [[nodiscard]] std::int64_t overwritten() const { return overwritten_; }

 private:
  std::size_t capacity_;
  std::vector<Entry> entries_;
  std::size_t next_ = 0, largest_ = 0;
  std::int64_t overwritten_ = 0;
};

using LatencyLog = NewestLog<FrameToCan>;
using WakeUpLog = NewestLog<std::int64_t>;

// Nearest-rank percentiles of one part, e.g. &FrameToCan::computing, or of the totals.
[[nodiscard]] LatencyFigures figures_of(const std::vector<FrameToCan>& entries,
                                        Duration FrameToCan::*part);
[[nodiscard]] LatencyFigures figures_of_totals(const std::vector<FrameToCan>& entries);

}  // namespace glint
