// Cost table of a board: cost per loop iteration, and the worst-case execution time (WCET) bound of
// a node.
//
// What:     bound = sum over the node's loops of count_max x cost (Li and Malik 1995, eq. (1), with
//           the counts' maxima in place of flow facts).
// Cost:     k_loops_max products a node; constexpr.
// Accuracy: rounded up to whole nanoseconds. As good as the table: the board file states how it was
//           made, and the bound identifies the table by its hash.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string_view>

#include "graph/loops.hpp"

namespace glint {

// Costs of one kernel, in the order of its node's k_loops, in picoseconds per iteration.
struct KernelCost {
  std::string_view kernel;  // its node's name: "FindBlobs"
  std::array<std::string_view, graph::k_loops_max> loops{};
  std::array<std::int64_t, graph::k_loops_max> cost_ps{};
};

// Costs of a board: generated at compile time, or views into a board file read at run time.
struct CostTable {
  std::string_view board;
  std::string_view build;   // compiler, version and flags for which the costs hold
  std::string_view sha256;  // of the board file
  std::span<const KernelCost> kernels;

  [[nodiscard]] constexpr const KernelCost* find(std::string_view kernel) const {
    for (const KernelCost& cost : kernels) {
      if (cost.kernel == kernel) return &cost;
    }
    return nullptr;
  }
};

[[nodiscard]] constexpr std::int64_t bound_ns(const KernelCost& cost,
                                              const graph::LoopCounts& worst) {
  std::int64_t sum_ps = 0;
  for (std::size_t loop = 0; loop < graph::k_loops_max; ++loop) {
    sum_ps += cost.cost_ps[loop] * worst[loop];
  }
  return (sum_ps + 999) / 1000;
}

}  // namespace glint
