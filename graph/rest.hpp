// Waiting of a worker for another one: bounded spinning, then sleep until the other reports
// progress. A waiting worker never occupies a core for longer than its spins.
#pragma once

#include <atomic>
#include <concepts>
#include <cstdint>

namespace glint::graph {

// Interface that the host implements: one object for all workers of a graph. A sleep has a maximum
// duration, so that the waiting worker can check again whether to continue.
template <class T>
concept WaitPolicy = requires(T& rest, std::uint32_t seen) {
  rest.spin();  // a CPU's pause instruction
  { rest.spins_max() } -> std::convertible_to<std::uint32_t>;
  { rest.progress() } -> std::same_as<std::uint32_t>;  // number of reports so far
  // Returns when progress() differs from `seen`. False: the maximum sleep ended first.
  { rest.sleep(seen) } -> std::same_as<bool>;
  rest.report_progress();  // after a store that another worker may wait for
};

// A wait longer than this number of maximum sleeps counts as an overrun.
inline constexpr std::uint64_t k_sleeps_max = 20;

// Waits until is_done() returns true. Returns false if go_on() ended the wait.
template <WaitPolicy R, class IsDone, class GoOn>
[[nodiscard]] bool wait_for(R& rest, std::atomic<std::uint64_t>& overruns, const IsDone& is_done,
                            const GoOn& go_on) noexcept {
  constexpr std::uint32_t k_spins_per_check = 16;  // reading the clock costs 20 ns, a spin 1 to 40
  for (std::uint32_t spin = 1; spin <= rest.spins_max(); ++spin) {
    if (is_done()) return true;
    if (spin % k_spins_per_check == 0 && !go_on()) return false;
    rest.spin();
  }
  for (std::uint64_t sleeps = 0;;) {
    const std::uint32_t seen = rest.progress();  // before is_done(): a later report ends the sleep
    if (is_done()) return true;
    if (!go_on()) return false;
    if (!rest.sleep(seen) && ++sleeps == k_sleeps_max) {
      overruns.fetch_add(1, std::memory_order_relaxed);
    }
  }
}

}  // namespace glint::graph
