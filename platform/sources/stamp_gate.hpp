// Orders the time stamps of recorded frames: real files have doubled, backward and far-off stamps,
// gaps, and clocks that restart.
//
// Accepts a stamp if it is newer than the last accepted one by at most k_stamp_step_max. Counts and
// skips others, and stamps beyond k_stamp_max. After k_restart_stamps skipped stamps in a row that
// ascend among themselves, the device's clock has restarted: time continues one nominal gap after
// the last accepted frame.
#pragma once

#include <cstdint>

#include "kernels/units.hpp"

namespace glint {

inline constexpr Duration k_gap_counted = milliseconds(1000);  // several times any frame gap
inline constexpr Duration k_stamp_step_max =
    milliseconds(3'600'000);                                   // a pause within one recording
inline constexpr Time k_stamp_max{4'000'000'000'000'000'000};  // the difference of two fits
inline constexpr int k_restart_stamps = 8;  // as the resynchronisation of CheckFrame

struct StampCounts {
  std::uint64_t doubled = 0, backward = 0, far_off = 0;  // skipped
  std::uint64_t gaps = 0, restarts = 0;                  // accepted
  Duration longest_gap;
};

class StampGate {
 public:
  explicit StampGate(Duration nominal_gap) : nominal_gap_(nominal_gap) {}

  // Returns whether the frame is accepted. If so, its stamp plus offset() ascends over all accepted
  // frames.
  [[nodiscard]] bool take(Time stamp);

  [[nodiscard]] Duration offset() const { return offset_; }
  [[nodiscard]] const StampCounts& counts() const { return counts_; }

 private:
  [[nodiscard]] bool restarts_at(Time stamp);

  Duration nominal_gap_;
  Duration offset_;
  StampCounts counts_;
  bool any_ = false;
  Time newest_;   // last accepted, device clock
  Time skipped_;  // last skipped
  int skipped_in_row_ = 0;
};

}  // namespace glint
