// Multi-threaded executor of a static schedule (graph/planned.hpp): the caller is worker 0, a pool
// hosts the others.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "graph/planned.hpp"
#include "platform/runtime/rt/worker_pool.hpp"
#include "platform/runtime/rt/worker_rest.hpp"

namespace glint {

template <class G>
class PlannedExecutor {
 public:
  // `others` has one entry for each worker of the plan except the first. A worker with its own core
  // and SCHED_FIFO spins `spins_max` times before it sleeps.
  PlannedExecutor(const graph::ScheduleTables<G>& plan, const std::vector<ThreadSettings>& others,
                  std::uint32_t spins_max)
      : pool_(checked(plan, others)),
        wait_policy_(pool_.reports(), spins_max),
        planned_(plan, wait_policy_) {}
  ~PlannedExecutor() { pool_.stop(); }  // a worker may still report its last progress
  PlannedExecutor(const PlannedExecutor&) = delete;
  PlannedExecutor& operator=(const PlannedExecutor&) = delete;

  // One trace per worker. Returns the last node that ran; call finish_activation() next.
  template <graph::Trace T, graph::Boundary B>
  [[nodiscard]] int execute(G& graph, std::span<T> traces, B& boundary) noexcept {
    planned_.begin(graph);
    if (planned_.workers() > 1) {
      graph_ = &graph;
      traces_ = traces.data();
      pool_.release(
          [](void* self, int worker) noexcept {
            auto& executor = *static_cast<PlannedExecutor*>(self);
            executor.planned_.run_worker(*executor.graph_, worker,
                                         static_cast<T*>(executor.traces_)[worker]);
          },
          this);
    }
    return planned_.run_leader(graph, traces[0], boundary);
  }
  void finish_activation(G& graph) noexcept { planned_.finish_activation(graph); }

  [[nodiscard]] std::uint64_t overruns() const noexcept { return planned_.overruns(); }
  [[nodiscard]] std::vector<ThreadReport> reports() const { return pool_.reports(); }

 private:
  static const std::vector<ThreadSettings>& checked(const graph::ScheduleTables<G>& plan,
                                                    const std::vector<ThreadSettings>& others) {
    if (graph::schedule_fault(plan).found()) throw std::logic_error("the plan was not checked");
    if (static_cast<int>(others.size()) != plan.workers - 1) {
      throw std::logic_error("settings for all workers but the first are needed");
    }
    return others;
  }

  G* graph_ = nullptr;
  void* traces_ = nullptr;
  WorkerPool pool_;
  WorkerWaitPolicy wait_policy_;
  graph::Planned<G, WorkerWaitPolicy> planned_;
};

}  // namespace glint
