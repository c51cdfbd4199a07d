// CPU cycle counter as a nanosecond clock: a read costs a third of a system clock read.
//
// For short intervals from an anchor on the system's clock. The counter's rate is measured once, to
// about 1e-4, so that a millisecond is exact within 100 ns.
#pragma once

#include <cstdint>

#if defined(__x86_64__)
#include <x86intrin.h>
#endif

#include "platform/runtime/rt/clock.hpp"

namespace glint {

[[nodiscard]] inline std::uint64_t cycle_count() noexcept {
#if defined(__x86_64__)
  return __rdtsc();
#elif defined(__aarch64__)
  std::uint64_t count = 0;
  __asm__ __volatile__("mrs %0, cntvct_el0" : "=r"(count));
  return count;
#else
  return static_cast<std::uint64_t>(monotonic_now().nanoseconds);
#endif
}

// Measured at the first call, for 5 ms: call it before time-critical work.
[[nodiscard]] double ns_per_cycle() noexcept;

}  // namespace glint
