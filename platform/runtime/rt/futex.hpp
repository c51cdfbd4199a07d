// Sleep until a counter changes: futex(2). POSIX's timed wait uses the settable clock, and the one
// of the C++ library does not guarantee which system calls it makes.
#pragma once

#include <linux/futex.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdint>
#include <ctime>

#include "kernels/units.hpp"

namespace glint {

static_assert(sizeof(std::atomic<std::uint32_t>) == sizeof(std::uint32_t),
              "the kernel reads the counter's bits");

// Who shares the counter: threads of one process, or processes that map the same memory.
enum class FutexUse : int { threads = FUTEX_PRIVATE_FLAG, processes = 0 };

// Sleeps while `counter` is `value`; may return early. Returns false if the deadline (monotonic;
// null: none) has passed.
[[nodiscard]] inline bool futex_sleep(std::atomic<std::uint32_t>& counter, std::uint32_t value,
                                      const Time* deadline,
                                      FutexUse use = FutexUse::threads) noexcept {
  constexpr std::int64_t k_nanoseconds = 1'000'000'000;
  timespec until{};
  if (deadline != nullptr) {
    until.tv_sec = static_cast<time_t>(deadline->nanoseconds / k_nanoseconds);
    until.tv_nsec = static_cast<long>(deadline->nanoseconds % k_nanoseconds);
  }
  const long result =
      syscall(SYS_futex, reinterpret_cast<std::uint32_t*>(&counter),
              FUTEX_WAIT_BITSET | static_cast<int>(use), value,
              deadline != nullptr ? &until : nullptr, nullptr, FUTEX_BITSET_MATCH_ANY);
  return !(result == -1 && errno == ETIMEDOUT);
}

inline void futex_wake(std::atomic<std::uint32_t>& counter, int threads_max,
                       FutexUse use = FutexUse::threads) noexcept {
  syscall(SYS_futex, reinterpret_cast<std::uint32_t*>(&counter), FUTEX_WAKE | static_cast<int>(use),
          threads_max, nullptr, nullptr, 0);
}

}  // namespace glint
