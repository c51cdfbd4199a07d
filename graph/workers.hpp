// The parallel executor: W workers run one graph together and give the same bytes as Serial.
//
// Copy i of a split runs on worker i % W, every other node on worker 0: a rule, not a guess, so
// that a plan can be made of it. Workers meet at a spin barrier before and after each level that
// has a split. Threads, their release and how a spin rests are the host's business. Worst input: a
// part that comes late. Its reader goes on waiting, since nobody else has the data, and counts one
// overrun when `spins_max` spins were not enough.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>

#include "graph/executor.hpp"
#include "graph/port.hpp"
#include "graph/type_list.hpp"

namespace glint::graph {

namespace detail {

// Whether a level has a split, so that workers beyond the first have something to do on it.
template <class G, int level>
inline constexpr bool wide = [] {
  for (int unit = 0; unit < G::unit_count; ++unit) {
    if (G::Wires::order.level[unit] == level && G::Wires::copies[unit] > 1) return true;
  }
  return false;
}();

}  // namespace detail

// Pause is called at each spin, from any worker: a CPU's pause instruction, or a yield where there
// are no real-time rights. Trace sees the nodes of all workers, each node from one of them.
template <int W, class Pause, Trace T = NoTrace>
class Workers {
  static_assert(W >= 1, "someone has to do the work");

 public:
  static constexpr int count = W;

  explicit Workers(std::uint32_t spins_max, Pause pause = {}, T trace = {}) noexcept
      : spins_max_(spins_max), pause_(pause), trace_(trace) {}

  // Worker 0, before it releases the others for an activation.
  template <class G>
  void begin(G& graph) noexcept {
    graph.begin_activation();
  }

  // Each worker once an activation, 0 <= worker < W. When worker 0 returns, all nodes have run.
  template <class G>
  void run(G& graph, int worker) noexcept {
    for_each_index<G::level_count>([&]<int level>() {
      if constexpr (level > 0 && (detail::wide<G, level - 1> || detail::wide<G, level>))
        meet(worker);
      for_each_index<G::unit_count>([&]<int step>() {
        constexpr int unit = G::Wires::order.units[step];
        if constexpr (G::Wires::order.level[unit] == level) run_unit<unit>(graph, worker);
      });
    });
    if constexpr (detail::wide<G, G::level_count - 1>) meet(worker);
  }

  // Waits that took more than spins_max spins, of all workers since the start.
  [[nodiscard]] std::uint64_t overruns() const noexcept {
    std::uint64_t sum = 0;
    for (const Own& own : own_) sum += own.overruns.load(std::memory_order_relaxed);
    return sum;
  }

 private:
  template <int unit, class G>
  void run_unit(G& graph, int worker) noexcept {
    for_each_index<G::Wires::copies[unit]>([&]<int copy>() {
      if (copy % W == worker) graph.template call<unit, copy>(trace_);
    });
  }

  // All workers have done what stands before this call when it returns. `arrived_` only ever grows,
  // so no worker can mistake one meeting for the next.
  void meet(int worker) noexcept {
    Own& own = own_[static_cast<std::size_t>(worker)];
    ++own.meetings;
    arrived_.fetch_add(1, std::memory_order_acq_rel);
    std::uint32_t spins = 0;
    while (arrived_.load(std::memory_order_acquire) < own.meetings * W) {
      if (spins < spins_max_) {
        ++spins;
        if (spins == spins_max_) own.overruns.fetch_add(1, std::memory_order_relaxed);
      }
      pause_();
    }
  }

  struct alignas(k_cache_line) Own {
    std::uint64_t meetings = 0;
    std::atomic<std::uint64_t> overruns{0};
  };
  alignas(k_cache_line) std::atomic<std::uint64_t> arrived_{0};
  std::array<Own, W> own_{};
  std::uint32_t spins_max_;
  [[no_unique_address]] Pause pause_;
  [[no_unique_address]] T trace_;
};

}  // namespace glint::graph
