// The board's clock, and sleeping by it.
#pragma once

#include "kernels/units.hpp"

namespace glint {

// CLOCK_MONOTONIC: never set, never steps; NTP may slew it. The `Time` that all of Glint speaks.
[[nodiscard]] Time monotonic_now() noexcept;

// Added to a monotonic time it gives nanoseconds since 1970 (UTC). Both clocks are read closely
// together several times and the tightest pair counts: exact to well under a microsecond, at the
// moment of the call; the system's clock may be set later.
[[nodiscard]] Duration unix_offset() noexcept;

// Sleeps until an absolute time, also across signals; returns at once when it has passed. False:
// the system refuses to sleep, and nothing was waited for.
[[nodiscard]] bool sleep_until(Time wake) noexcept;

}  // namespace glint
