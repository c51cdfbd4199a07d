// Activates a tracker with one worker or with two; the bytes are the same.
#pragma once

#include <memory>
#include <vector>

#include "platform/rt/worker_pool.hpp"

namespace glint {

class TrackerExecutor {
 public:
  // A wait for the other worker beyond this many spins counts as an overrun: some milliseconds.
  static constexpr std::uint32_t k_spins_max = 100'000;

  explicit TrackerExecutor(int workers, int priority = 0) {
    if (workers < 2) return;
    const std::vector<ThreadSettings> others{
        {.name = "glint-worker", .core = -1, .priority = priority}};
    pair_ = std::make_unique<ParallelExecutor<2>>(others, k_spins_max);
  }

  template <class G>
  void activate(G& graph) noexcept {
    if (pair_ == nullptr) {
      graph.activate();
    } else {
      graph.activate(*pair_);
    }
  }

  [[nodiscard]] std::uint64_t overruns() const { return pair_ == nullptr ? 0 : pair_->overruns(); }
  [[nodiscard]] std::vector<ThreadReport> reports() const {
    return pair_ == nullptr ? std::vector<ThreadReport>{} : pair_->reports();
  }

 private:
  std::unique_ptr<ParallelExecutor<2>> pair_;
};

}  // namespace glint
