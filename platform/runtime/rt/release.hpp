// Counting semaphore that releases a waiting thread; a release before the wait is not lost. Frame
// groups and workers block here only.
#pragma once

#include <atomic>
#include <cstdint>

#include "kernels/units.hpp"

namespace glint {

class Release {
 public:
  Release() = default;
  Release(const Release&) = delete;
  Release& operator=(const Release&) = delete;

  // From any thread: releases one wait(). One atomic operation and one system call, never blocks.
  void post() noexcept;
  // Consumes one release; waits for it if necessary.
  void wait() noexcept;
  // The same, with a timeout: returns false at `deadline` (monotonic).
  [[nodiscard]] bool wait_until(Time deadline) noexcept;

 private:
  [[nodiscard]] bool take() noexcept;
  [[nodiscard]] bool wait_for(const Time* deadline) noexcept;
  std::atomic<std::uint32_t> count_{0};
};

}  // namespace glint
