// Thread pool for the workers of a graph; worker 0 is the caller.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <stdexcept>
#include <vector>

#include "graph/workers.hpp"
#include "platform/runtime/rt/real_time_thread.hpp"
#include "platform/runtime/rt/release.hpp"
#include "platform/runtime/rt/worker_rest.hpp"

namespace glint {

// Threads that wait for a release, call one function and wait again. They are always armed for the
// AllocationCounter.
class WorkerPool {
 public:
  using Job = void (*)(void* context, int worker) noexcept;

  // One thread per entry: workers 1, 2, ...
  explicit WorkerPool(const std::vector<ThreadSettings>& settings);
  ~WorkerPool() { stop(); }
  WorkerPool(const WorkerPool&) = delete;
  WorkerPool& operator=(const WorkerPool&) = delete;

  // Every thread calls job(context, worker) once. Before the next release all of them must have
  // started it, for example by synchronising with the caller inside the job.
  void release(Job job, void* context) noexcept;

  // Returns after all threads have ended; no release() may follow.
  void stop() noexcept;

  [[nodiscard]] std::vector<ThreadReport> reports() const;

 private:
  void wait_and_work(Release& release, int worker) noexcept;

  Job job_ = nullptr;
  void* context_ = nullptr;
  std::atomic<bool> stop_{false};
  std::vector<std::unique_ptr<Release>> releases_;
  std::vector<std::unique_ptr<RealTimeThread>> threads_;
};

// Runs graphs on W workers: graph.activate(executor). The caller's thread is worker 0.
template <int W>
class ParallelExecutor {
 public:
  // `others` has W - 1 entries. A worker with its own core and SCHED_FIFO spins `spins_max` times
  // before it sleeps.
  ParallelExecutor(const std::vector<ThreadSettings>& others, std::uint32_t spins_max)
      : pool_(checked(others)), wait_policy_(pool_.reports(), spins_max), workers_(wait_policy_) {}
  ~ParallelExecutor() { pool_.stop(); }  // a worker may still report its last progress
  ParallelExecutor(const ParallelExecutor&) = delete;
  ParallelExecutor& operator=(const ParallelExecutor&) = delete;

  template <class G>
  void execute(G& graph) noexcept {
    workers_.begin(graph);
    // Release only workers that synchronise with worker 0: this shows that they have started.
    if constexpr (W > 1 && G::has_split) {
      graph_ = &graph;
      pool_.release(
          [](void* self, int worker) noexcept {
            auto& executor = *static_cast<ParallelExecutor*>(self);
            executor.workers_.run(*static_cast<G*>(executor.graph_), worker);
          },
          this);
    }
    workers_.run(graph, 0);
  }

  [[nodiscard]] std::uint64_t overruns() const noexcept { return workers_.overruns(); }
  [[nodiscard]] std::vector<ThreadReport> reports() const { return pool_.reports(); }

 private:
  static const std::vector<ThreadSettings>& checked(const std::vector<ThreadSettings>& others) {
    if (others.size() != W - 1) throw std::logic_error("settings for W - 1 workers are needed");
    return others;
  }

  void* graph_ = nullptr;
  WorkerPool pool_;
  WorkerWaitPolicy wait_policy_;
  graph::Workers<W, WorkerWaitPolicy> workers_;
};

}  // namespace glint
