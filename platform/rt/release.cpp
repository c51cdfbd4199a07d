// A semaphore on the futex itself: POSIX's timed wait follows the settable clock, and the one of
// the C++ library does not promise which system calls it makes.
#include "platform/rt/release.hpp"

#include <linux/futex.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cerrno>
#include <ctime>

namespace glint {
namespace {

static_assert(sizeof(std::atomic<std::uint32_t>) == sizeof(std::uint32_t),
              "the kernel looks at the counter's bits");

// False only when the deadline has passed.
bool sleep_while_zero(std::atomic<std::uint32_t>& count, const timespec* deadline) noexcept {
  const long result =
      syscall(SYS_futex, reinterpret_cast<std::uint32_t*>(&count),
              FUTEX_WAIT_BITSET | FUTEX_PRIVATE_FLAG, 0, deadline, nullptr, FUTEX_BITSET_MATCH_ANY);
  return !(result == -1 && errno == ETIMEDOUT);
}

}  // namespace

void Release::post() noexcept {
  count_.fetch_add(1, std::memory_order_release);
  syscall(SYS_futex, reinterpret_cast<std::uint32_t*>(&count_), FUTEX_WAKE | FUTEX_PRIVATE_FLAG, 1,
          nullptr, nullptr, 0);
}

bool Release::take() noexcept {
  std::uint32_t count = count_.load(std::memory_order_relaxed);
  while (count > 0) {
    if (count_.compare_exchange_weak(count, count - 1, std::memory_order_acquire,
                                     std::memory_order_relaxed)) {
      return true;
    }
  }
  return false;
}

bool Release::wait_for(const Time* deadline) noexcept {
  timespec until{};
  if (deadline != nullptr) {
    until.tv_sec = static_cast<time_t>(deadline->nanoseconds / 1'000'000'000);
    until.tv_nsec = static_cast<long>(deadline->nanoseconds % 1'000'000'000);
  }
  while (!take()) {
    if (!sleep_while_zero(count_, deadline != nullptr ? &until : nullptr)) return false;
  }
  return true;
}

void Release::wait() noexcept { (void)wait_for(nullptr); }

bool Release::wait_until(Time deadline) noexcept { return wait_for(&deadline); }

}  // namespace glint
