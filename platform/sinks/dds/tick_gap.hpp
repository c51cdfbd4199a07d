// Number of tick periods between two ticks, rounded. A period need not be a whole number of
// nanoseconds (300 Hz): between consecutive ticks the error is far below half a period.
#pragma once

#include "kernels/units.hpp"

namespace glint {

[[nodiscard]] constexpr std::int64_t ticks_between(Time from, Time to, Duration period) {
  const std::int64_t twice = 2 * (to - from).nanoseconds + period.nanoseconds;
  const std::int64_t whole = 2 * period.nanoseconds;
  return twice / whole - (twice % whole < 0 ? 1 : 0);
}

}  // namespace glint
