// What releases a waiting thread: counted, so that a release before the wait is not lost. The only
// place where a frame group or a worker blocks.
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

  // From any thread: lets one wait() through. One atomic step and one system call, never blocks.
  void post() noexcept;
  // Takes one release, waiting for it if need be.
  void wait() noexcept;
  // The same, but gives up at `deadline` (monotonic): false.
  [[nodiscard]] bool wait_until(Time deadline) noexcept;

 private:
  [[nodiscard]] bool take() noexcept;
  [[nodiscard]] bool wait_for(const Time* deadline) noexcept;
  std::atomic<std::uint32_t> count_{0};
};

}  // namespace glint
