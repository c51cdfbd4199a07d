// How a worker waits for another one: it spins for a bounded number of times, then it sleeps until
// the other one reports progress. A waiting worker never keeps a core for longer than its spins.
#pragma once

#include <atomic>
#include <concepts>
#include <cstdint>

namespace glint::graph {

// What the host provides: one object for all workers of a graph. A sleep has a longest duration, so
// that the waiting worker can check again whether to go on.
template <class T>
concept Rest = requires(T& rest, std::uint32_t seen) {
  rest.spin();  // a CPU's pause instruction
  { rest.spins_max() } -> std::convertible_to<std::uint32_t>;
  { rest.progress() } -> std::same_as<std::uint32_t>;  // reports so far
  // Returns when progress() is no longer `seen`. False: the longest sleep ended first.
  { rest.sleep(seen) } -> std::same_as<bool>;
  rest.report_progress();  // after a store that another worker may wait for
};

// A wait that outlasts this many whole sleeps counts as an overrun.
inline constexpr std::uint64_t k_sleeps_max = 20;

// Waits until there() holds. False: go_on() ended the wait.
template <Rest R, class There, class GoOn>
[[nodiscard]] bool wait_for(R& rest, std::atomic<std::uint64_t>& overruns, const There& there,
                            const GoOn& go_on) noexcept {
  constexpr std::uint32_t k_spins_a_look = 16;  // a look at the clock costs 20 ns, a spin 1 to 40
  for (std::uint32_t spin = 1; spin <= rest.spins_max(); ++spin) {
    if (there()) return true;
    if (spin % k_spins_a_look == 0 && !go_on()) return false;
    rest.spin();
  }
  for (std::uint64_t sleeps = 0;;) {
    const std::uint32_t seen = rest.progress();  // before the look: a later report ends the sleep
    if (there()) return true;
    if (!go_on()) return false;
    if (!rest.sleep(seen) && ++sleeps == k_sleeps_max) {
      overruns.fetch_add(1, std::memory_order_relaxed);
    }
  }
}

}  // namespace glint::graph
