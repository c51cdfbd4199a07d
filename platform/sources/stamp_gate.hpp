// Orders the stamps of recorded frames: real files have doubled, backward and far-off ones, gaps,
// and clocks that restart.
//
// A stamp is taken if it is newer than the last taken one by less than k_leap_max. Others are
// counted and skipped, as are stamps beyond k_stamp_max. After k_restart_stamps skipped ones in a
// row that ascend among themselves, the device's clock has restarted: the time goes on one nominal
// gap after the last taken frame.
#pragma once

#include <cstdint>

#include "kernels/units.hpp"

namespace glint {

inline constexpr Duration k_gap_counted = milliseconds(1000);    // several times any frame gap
inline constexpr Duration k_leap_max = milliseconds(3'600'000);  // a pause of one recording
inline constexpr Time k_stamp_max{4'000'000'000'000'000'000};    // differences of two fit
inline constexpr int k_restart_stamps = 8;  // as CheckFrame's resynchronisation

struct StampCounts {
  std::uint64_t doubled = 0, backward = 0, leaps = 0;  // skipped
  std::uint64_t gaps = 0, restarts = 0;                // taken
  Duration longest_gap;
};

class StampGate {
 public:
  explicit StampGate(Duration nominal_gap) : nominal_gap_(nominal_gap) {}

  // Whether the frame is taken. If so, `offset()` added to its stamp ascends over all taken frames.
  [[nodiscard]] bool take(Time stamp);

  [[nodiscard]] Duration offset() const { return offset_; }
  [[nodiscard]] const StampCounts& counts() const { return counts_; }

 private:
  [[nodiscard]] bool restarts_at(Time stamp);

  Duration nominal_gap_;
  Duration offset_;
  StampCounts counts_;
  bool any_ = false;
  Time newest_;   // of the taken, by the device's clock
  Time skipped_;  // of the newest skipped
  int skipped_in_row_ = 0;
};

}  // namespace glint
