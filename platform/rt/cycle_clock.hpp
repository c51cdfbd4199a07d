// The CPU's own counter as a clock of nanoseconds: a look at it costs a third of a system clock's.
//
// For short times only, from an anchor that the system's clock gives: what it counts at is measured
// once, to some 1e-4, so that a millisecond is right within 100 ns.
#pragma once

#include <cstdint>

#if defined(__x86_64__)
#include <x86intrin.h>
#endif

#include "platform/rt/clock.hpp"

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

// Measured at the first call, for 5 ms: call it before anything is in a hurry.
[[nodiscard]] double ns_per_cycle() noexcept;

}  // namespace glint
