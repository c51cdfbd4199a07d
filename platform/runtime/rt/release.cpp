#include "platform/runtime/rt/release.hpp"

#include "platform/runtime/rt/futex.hpp"

namespace glint {

void Release::post() noexcept {
  count_.fetch_add(1, std::memory_order_release);
  futex_wake(count_, 1);
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
  while (!take()) {
    if (!futex_sleep(count_, 0, deadline)) return false;
  }
  return true;
}

void Release::wait() noexcept { (void)wait_for(nullptr); }

bool Release::wait_until(Time deadline) noexcept { return wait_for(&deadline); }

}  // namespace glint
