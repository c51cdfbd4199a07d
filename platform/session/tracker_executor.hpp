// Activates a tracker with one worker or with two; the bytes are the same.
#pragma once

#include <memory>
#include <vector>

#include "platform/rt/worker_pool.hpp"
#include "platform/rt/worker_rest.hpp"

namespace glint {

class TrackerExecutor {
 public:
  explicit TrackerExecutor(int workers) {
    if (workers < 2) return;
    const std::vector<ThreadSettings> others{{.name = "glint-worker"}};
    pair_ = std::make_unique<ParallelExecutor<2>>(others, WorkerRest::k_shared_core_spins_max);
  }

  template <class G>
  void activate(G& graph) noexcept {
    if (pair_ == nullptr) {
      graph.activate();
    } else {
      graph.activate(*pair_);
    }
  }

 private:
  std::unique_ptr<ParallelExecutor<2>> pair_;
};

}  // namespace glint
