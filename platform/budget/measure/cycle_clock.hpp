// The processor's own steady counter: the time-stamp counter, or arm64's virtual count.
#pragma once

#include <chrono>
#include <cstdint>

#if defined(__x86_64__)
#include <x86intrin.h>
#endif

namespace glint {

// Waits for what was begun before, so that nothing is counted outside its own interval.
[[nodiscard]] inline std::uint64_t cycle_count() noexcept {
#if defined(__x86_64__)
  unsigned core = 0;
  const std::uint64_t count = __rdtscp(&core);
  _mm_lfence();
  return count;
#elif defined(__aarch64__)
  std::uint64_t count = 0;
  asm volatile("isb\n\tmrs %0, cntvct_el0\n\tisb" : "=r"(count)::"memory");
  return count;
#else
#error "no steady counter is known for this architecture"
#endif
}

// Nanoseconds a count, against the system's clock over 50 ms.
[[nodiscard]] inline double nanoseconds_of_a_count() {
  using Clock = std::chrono::steady_clock;
  const auto begin = Clock::now();
  const std::uint64_t first = cycle_count();
  while (Clock::now() - begin < std::chrono::milliseconds(50)) {
  }
  const std::uint64_t last = cycle_count();
  const std::chrono::duration<double, std::nano> elapsed = Clock::now() - begin;
  return elapsed.count() / static_cast<double>(last - first);
}

}  // namespace glint
