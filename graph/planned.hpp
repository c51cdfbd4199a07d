// Planned executor: W workers follow static per-worker schedules, synchronised by data, without
// barriers.
//
// A node starts when every node whose data it reads has finished; each node stores the activation's
// number when it finishes. Nodes of one worker need no check: the schedule preserves the order of
// their data. The output has the bytes of Serial. Worst input: a delayed node. Its reader keeps
// waiting (rest.hpp), as no other node writes the data, and counts one overrun. Meanwhile worker 0
// queries the boundary, so that a watched activation ends at its deadline without delay of the
// output. finish_activation() waits for a worker that is still inside a node, after the output is
// published.
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

template <class G, WaitPolicy R>
class Planned {
 public:
  // Requires tables without a fault by schedule_fault(). `rest` must outlive this object.
  Planned(const ScheduleTables<G>& tables, R& rest) noexcept : tables_(tables), rest_(&rest) {
    for (int node = 0; node < G::node_count; ++node) {
      const auto i = static_cast<std::size_t>(node);
      remote_predecessors_[i] = predecessors<G>[i] & ~tables_.nodes_of(tables_.worker[i]);
      awaited_ |= remote_predecessors_[i];
    }
  }

  [[nodiscard]] int workers() const noexcept { return tables_.workers; }

  // Call on worker 0, after finish_activation() and before it releases the others for an
  // activation.
  void begin(G& graph) noexcept {
    graph.begin_activation();
    ++activation_;
  }

  // Call on workers 1 and above, each once per activation.
  template <Trace T>
  void run_worker(G& graph, int worker, T& trace) noexcept {
    const auto w = static_cast<std::size_t>(worker);
    for (int step = 0; step < tables_.count[w]; ++step) {
      const int node = tables_.order[w][static_cast<std::size_t>(step)];
      if (!await(node, worker, [] { return true; })) break;
      run_node(graph, node, trace);
    }
    finished_[w].at.store(activation_, std::memory_order_release);
    rest_->report_progress();
  }

  // Call on worker 0. Returns the last node of the gap-free prefix of the execution order that has
  // run; the last node of all if every node has run, even if the boundary then returned false.
  // Nodes beyond a gap may have run on other workers. Therefore no node with state may follow a
  // split, or a replay would differ.
  template <Trace T, Boundary B>
  [[nodiscard]] int run_leader(G& graph, T& trace, B& boundary) noexcept {
    int last = -1;
    const auto goes_on = [&] { return last < 0 || boundary.go_on(last); };
    const int count = tables_.count[0];
    for (int step = 0; step < count; ++step) {
      const int node = tables_.order[0][static_cast<std::size_t>(step)];
      if (!await(node, 0, goes_on)) return abandon();
      run_node(graph, node, trace);
      last = node;
      // After the last node, stopping saves nothing.
      if (!boundary.go_on(node) && !(step + 1 == count && others_have_run())) return abandon();
    }
    for (int worker = 1; worker < tables_.workers; ++worker) {
      const Mark& mark = finished_[static_cast<std::size_t>(worker)];
      if (!wait(0, goes_on, [&] { return is_now(mark); })) return abandon();
    }
    return G::node_count - 1;
  }

  // Call on worker 0 once after each run_leader(). Waits until no other worker is inside the graph,
  // then undoes the feedback of an abandoned activation. The wait is bounded by the longest node in
  // progress; the activation's output is already published.
  void finish_activation(G& graph) noexcept {
    for (int worker = 1; worker < tables_.workers; ++worker) {
      const Mark& mark = finished_[static_cast<std::size_t>(worker)];
      (void)wait(
          0, [] { return true; }, [&] { return is_now(mark); });
    }
    if (is_now(abandoned_)) graph.abandon_activation();
  }

  // Number of waits longer than rest.hpp allows, over all workers since the start.
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

  // Returns false if the activation was abandoned before or during the wait.
  template <class GoesOn>
  [[nodiscard]] bool await(int node, int worker, const GoesOn& goes_on) noexcept {
    if (worker != 0 && is_now(abandoned_)) return false;
    const NodeSet remote = remote_predecessors_[static_cast<std::size_t>(node)];
    for (int other = 0; other < G::node_count; ++other) {
      if ((remote >> other & 1u) == 0) continue;
      if (!wait(worker, goes_on, [&] { return has_run(other); })) return false;
    }
    return true;
  }
  template <class GoesOn, class IsDone>
  [[nodiscard]] bool wait(int worker, const GoesOn& goes_on, const IsDone& is_done) noexcept {
    return wait_for(*rest_, overruns_[static_cast<std::size_t>(worker)].at, is_done,
                    [&] { return !(worker != 0 && is_now(abandoned_)) && goes_on(); });
  }

  // Never returns the last node, even if the others have finished by now: the feedback is undone.
  int abandon() noexcept {
    abandoned_.at.store(activation_, std::memory_order_release);
    rest_->report_progress();
    int last = 0;
    while (last + 2 < G::node_count && has_run(last + 1)) ++last;
    return last;
  }

  ScheduleTables<G> tables_;
  std::array<NodeSet, static_cast<std::size_t>(G::node_count)> remote_predecessors_{};
  NodeSet awaited_ = 0;           // nodes that another worker waits for
  std::uint64_t activation_ = 0;  // from 1; written by worker 0 before it releases the others
  std::array<Mark, static_cast<std::size_t>(G::node_count)> done_{};
  std::array<Mark, k_plan_workers_max> finished_{};
  std::array<Mark, k_plan_workers_max> overruns_{};
  Mark abandoned_;
  R* rest_;
};

}  // namespace glint::graph
