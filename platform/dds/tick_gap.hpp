// How many tick periods lie between two ticks. A period need not be whole nanoseconds (300 Hz), so
// it is rounded: between neighbours the error is far below half a period.
#pragma once

#include "kernels/units.hpp"

namespace glint {

[[nodiscard]] constexpr std::int64_t ticks_between(Time from, Time to, Duration period) {
  const std::int64_t twice = 2 * (to - from).nanoseconds + period.nanoseconds;
  const std::int64_t whole = 2 * period.nanoseconds;
  return twice / whole - (twice % whole < 0 ? 1 : 0);
}

}  // namespace glint
