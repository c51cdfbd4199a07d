// The companion computer's monotonic clock, and sleep until an absolute time.
#pragma once

#include "kernels/units.hpp"

namespace glint {

// CLOCK_MONOTONIC: never set, never steps; NTP may slew it. The clock of every `Time` in Glint.
[[nodiscard]] Time monotonic_now() noexcept;

// Offset to add to a monotonic time to obtain nanoseconds since 1970 (UTC). Reads both clocks
// several times and uses the closest pair: exact to well under a microsecond at the time of the
// call. The system's clock may be set later.
[[nodiscard]] Duration unix_offset() noexcept;

// Sleeps until an absolute time, also across signals; returns at once if it has passed. Returns
// false if the system call fails; then it did not wait.
[[nodiscard]] bool sleep_until(Time wake) noexcept;

}  // namespace glint
