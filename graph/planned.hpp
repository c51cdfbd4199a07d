// The planned executor: W workers follow an order made ahead for each of them, without a barrier.
//
// A node begins when every node whose data it reads has ended, which each node says by storing the
// activation's number. Nodes of one worker need no such look: the plan's order holds the data's.
// The bytes are Serial's. Worst input: a part that comes late. Its reader goes on waiting
// (rest.hpp), as no other node writes the data, and counts one overrun; worker 0 asks the boundary
// meanwhile, so that a watched activation ends at its deadline and the output need not wait. A
// worker that is still inside a node then is waited for by settle(), after the output has left.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>

#include "graph/executor.hpp"
#include "graph/plan_tables.hpp"
#include "graph/port.hpp"
#include "graph/rest.hpp"
#include "graph/watch.hpp"

namespace glint::graph {

template <class G, Rest R>
class Planned {
 public:
  // The tables were checked: plan_fault() found none. `rest` outlives this.
  Planned(const PlanTables<G>& tables, R& rest) noexcept : tables_(tables), rest_(&rest) {
    for (int node = 0; node < G::node_count; ++node) {
      const auto i = static_cast<std::size_t>(node);
      foreign_[i] = needs<G>[i] & ~tables_.nodes_of(tables_.worker[i]);
      awaited_ |= foreign_[i];
    }
  }

  [[nodiscard]] int workers() const noexcept { return tables_.workers; }

  // Worker 0, after settle() and before it releases the others for an activation.
  void begin(G& graph) noexcept {
    graph.begin_activation();
    ++activation_;
  }

  // Workers 1 and on, each once an activation.
  template <Trace T>
  void help(G& graph, int worker, T& trace) noexcept {
    const auto w = static_cast<std::size_t>(worker);
    for (int step = 0; step < tables_.count[w]; ++step) {
      const int node = tables_.order[w][static_cast<std::size_t>(step)];
      if (!await(node, worker, [] { return true; })) break;
      run_node(graph, node, trace);
    }
    finished_[w].at.store(activation_, std::memory_order_release);
    rest_->report_progress();
  }

  // Worker 0. Gives how far the graph's order has run without a gap: its last node where all have
  // run, also where the boundary said no only after that. (Beyond a gap a node may have run as
  // well, on another worker: so no node that keeps a state may stand behind a split, or a replay
  // would see it differ.)
  template <Trace T, Boundary B>
  [[nodiscard]] int lead(G& graph, T& trace, B& boundary) noexcept {
    int last = -1;
    const auto goes_on = [&] { return last < 0 || boundary.go_on(last); };
    const int count = tables_.count[0];
    for (int step = 0; step < count; ++step) {
      const int node = tables_.order[0][static_cast<std::size_t>(step)];
      if (!await(node, 0, goes_on)) return abandon();
      run_node(graph, node, trace);
      last = node;
      // After the group's last node nothing is left to be saved by stopping.
      if (!boundary.go_on(node) && !(step + 1 == count && others_have_run())) return abandon();
    }
    for (int worker = 1; worker < tables_.workers; ++worker) {
      const Mark& mark = finished_[static_cast<std::size_t>(worker)];
      if (!wait(0, goes_on, [&] { return is_now(mark); })) return abandon();
    }
    return G::node_count - 1;
  }

  // Worker 0, once after each lead(): returns when no other worker is inside the graph, and only
  // then takes back what an abandoned activation would have fed back. The wait is bounded by the
  // longest node that one of them is in; what leaves for this activation has left before.
  void settle(G& graph) noexcept {
    for (int worker = 1; worker < tables_.workers; ++worker) {
      const Mark& mark = finished_[static_cast<std::size_t>(worker)];
      (void)wait(
          0, [] { return true; }, [&] { return is_now(mark); });
    }
    if (is_now(abandoned_)) graph.abandon_activation();
  }

  // Waits that were longer than rest.hpp allows, of all workers since the start.
  [[nodiscard]] std::uint64_t overruns() const noexcept {
    std::uint64_t sum = 0;
    for (const Mark& mark : overruns_) sum += mark.at.load(std::memory_order_relaxed);
    return sum;
  }

 private:
  struct alignas(k_cache_line) Mark {
    std::atomic<std::uint64_t> at{0};
  };

  [[nodiscard]] bool is_now(const Mark& mark) const noexcept {
    return mark.at.load(std::memory_order_acquire) == activation_;
  }
  [[nodiscard]] bool has_run(int node) const noexcept {
    return is_now(done_[static_cast<std::size_t>(node)]);
  }
  [[nodiscard]] bool others_have_run() const noexcept {
    for (int node = 0; node < G::node_count; ++node) {
      if (tables_.worker[static_cast<std::size_t>(node)] != 0 && !has_run(node)) return false;
    }
    return true;
  }

  template <Trace T>
  void run_node(G& graph, int node, T& trace) noexcept {
    graph.call_number(node, trace);
    done_[static_cast<std::size_t>(node)].at.store(activation_, std::memory_order_release);
    if ((awaited_ >> node & 1u) != 0) rest_->report_progress();
  }

  // False: the activation was abandoned while this worker waited, or before.
  template <class GoesOn>
  [[nodiscard]] bool await(int node, int worker, const GoesOn& goes_on) noexcept {
    if (worker != 0 && is_now(abandoned_)) return false;
    const NodeSet foreign = foreign_[static_cast<std::size_t>(node)];
    for (int other = 0; other < G::node_count; ++other) {
      if ((foreign >> other & 1u) == 0) continue;
      if (!wait(worker, goes_on, [&] { return has_run(other); })) return false;
    }
    return true;
  }
  template <class GoesOn, class There>
  [[nodiscard]] bool wait(int worker, const GoesOn& goes_on, const There& there) noexcept {
    return wait_for(*rest_, overruns_[static_cast<std::size_t>(worker)].at, there,
                    [&] { return !(worker != 0 && is_now(abandoned_)) && goes_on(); });
  }

  // What the others may have done by now does not count as all: the feedback will be undone.
  int abandon() noexcept {
    abandoned_.at.store(activation_, std::memory_order_release);
    rest_->report_progress();
    int last = 0;
    while (last + 2 < G::node_count && has_run(last + 1)) ++last;
    return last;
  }

  PlanTables<G> tables_;
  std::array<NodeSet, static_cast<std::size_t>(G::node_count)> foreign_{};
  NodeSet awaited_ = 0;           // nodes that another worker waits for
  std::uint64_t activation_ = 0;  // counts from 1; written by worker 0 before it releases others
  std::array<Mark, static_cast<std::size_t>(G::node_count)> done_{};
  std::array<Mark, k_plan_workers_max> finished_{};
  std::array<Mark, k_plan_workers_max> overruns_{};
  Mark abandoned_;
  R* rest_;
};

}  // namespace glint::graph
