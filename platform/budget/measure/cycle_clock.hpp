// Constant-rate counter of the processor: the time-stamp counter, or arm64's virtual count.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>

#if defined(__x86_64__)
#include <x86intrin.h>
#endif

namespace glint {

// Serialising read: earlier instructions are complete, so that each counts in its own interval.
[[nodiscard]] inline std::uint64_t serialised_count() noexcept {
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
#error "no steady counter for this architecture"
#endif
}

// Nanoseconds per count, calibrated against the system's clock over 50 ms.
[[nodiscard]] inline double nanoseconds_per_count() {
  using Clock = std::chrono::steady_clock;
  const auto begin = Clock::now();
  const std::uint64_t first = serialised_count();
  while (Clock::now() - begin < std::chrono::milliseconds(50)) {
  }
  const std::uint64_t last = serialised_count();
  const std::chrono::duration<double, std::nano> elapsed = Clock::now() - begin;
  return elapsed.count() / static_cast<double>(last - first);
}

// Smallest nonzero difference of two readings: on some machines the counter advances in steps of
// many counts.
[[nodiscard]] inline std::uint64_t counter_step() {
  std::uint64_t least = ~std::uint64_t{0};
  std::uint64_t before = serialised_count();
  for (int reading = 0; reading < 10'000; ++reading) {
    const std::uint64_t now = serialised_count();
    if (now != before) least = std::min(least, now - before);
    before = now;
  }
  return least;
}

}  // namespace glint
