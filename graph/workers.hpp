// Barrier executor: W workers run one graph in parallel and produce the same bytes as Serial.
//
// Copy i of a split runs on worker i % W, every other node on worker 0: a fixed rule that a
// schedule can reproduce (default_schedule). Workers meet at a barrier before and after each level
// that has a split. The host provides the threads, releases them and implements WaitPolicy
// (rest.hpp). Worst input: a delayed part. Its reader keeps waiting, as no other node writes the
// data, and counts one overrun.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>

#include "graph/executor.hpp"
#include "graph/port.hpp"
#include "graph/rest.hpp"
#include "graph/type_list.hpp"

namespace glint::graph {

namespace detail {

// True if a level has a split, so that workers beyond the first have nodes to run.
template <class G, int level>
inline constexpr bool has_split = [] {
  for (int unit = 0; unit < G::unit_count; ++unit) {
    if (G::Wires::order.level[unit] == level && G::Wires::copies[unit] > 1) return true;
  }
  return false;
}();

}  // namespace detail

// Trace receives the nodes of all workers, each node from one of them.
template <int W, WaitPolicy R, Trace T = NoTrace>
class Workers {
  static_assert(W >= 1, "at least one worker");

 public:
  static constexpr int count = W;

  // `rest` must outlive this object.
  explicit Workers(R& rest, T trace = {}) noexcept : rest_(&rest), trace_(trace) {}

  // Call on worker 0, before it releases the others for an activation.
  template <class G>
  void begin(G& graph) noexcept {
    graph.begin_activation();
  }

  // Call on each worker once per activation, 0 <= worker < W. When worker 0 returns, all nodes have
  // run.
  template <class G>
  void run(G& graph, int worker) noexcept {
    for_each_index<G::level_count>([&]<int level>() {
      if constexpr (level > 0 && (detail::has_split<G, level - 1> || detail::has_split<G, level>))
        barrier(worker);
      for_each_index<G::unit_count>([&]<int step>() {
        constexpr int unit = G::Wires::order.units[step];
        if constexpr (G::Wires::order.level[unit] == level) run_unit<unit>(graph, worker);
      });
    });
    if constexpr (detail::has_split<G, G::level_count - 1>) barrier(worker);
  }

  // Number of waits longer than rest.hpp allows, over all workers since the start.
  [[nodiscard]] std::uint64_t overruns() const noexcept {
    std::uint64_t sum = 0;
    for (const PerWorker& own : own_) sum += own.overruns.load(std::memory_order_relaxed);
    return sum;
  }

 private:
  template <int unit, class G>
  void run_unit(G& graph, int worker) noexcept {
    for_each_index<G::Wires::copies[unit]>([&]<int copy>() {
      if (copy % W == worker) graph.template call<unit, copy>(trace_);
    });
  }

  // Barrier: returns when all workers have called it. `arrived_` only increases, so that a worker
  // cannot confuse two barriers.
  void barrier(int worker) noexcept {
    PerWorker& own = own_[static_cast<std::size_t>(worker)];
    const std::uint64_t all = ++own.barriers * W;
    if (arrived_.fetch_add(1, std::memory_order_acq_rel) + 1 == all) rest_->report_progress();
    (void)wait_for(  // the last one finds all there at its first look
        *rest_, own.overruns, [&] { return arrived_.load(std::memory_order_acquire) >= all; },
        [] { return true; });
  }

  struct alignas(k_cache_line) PerWorker {
    std::uint64_t barriers = 0;
    std::atomic<std::uint64_t> overruns{0};
  };
  alignas(k_cache_line) std::atomic<std::uint64_t> arrived_{0};
  std::array<PerWorker, W> own_{};
  R* rest_;
  [[no_unique_address]] T trace_;
};

}  // namespace glint::graph
