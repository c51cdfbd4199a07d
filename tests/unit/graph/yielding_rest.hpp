// Waiting policy for tests: spin and sleep both yield.
#pragma once

#include <cstdint>
#include <thread>

#include "graph/rest.hpp"

namespace glint::test {

struct YieldingRest {
  std::uint32_t spins = 1'000'000;
  void spin() const noexcept { std::this_thread::yield(); }
  [[nodiscard]] std::uint32_t spins_max() const noexcept { return spins; }
  [[nodiscard]] std::uint32_t progress() const noexcept { return 0; }
  [[nodiscard]] bool sleep(std::uint32_t /*seen*/) const noexcept {
    std::this_thread::yield();
    return false;
  }
  void report_progress() const noexcept {}
};
static_assert(graph::WaitPolicy<YieldingRest>);

}  // namespace glint::test
