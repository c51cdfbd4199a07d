// What a loop costs on a board, and so what a node may need there at worst.
//
// What:     bound = sum over the node's loops of count_max x cost (Li and Malik 1995, eq. (1), with
//           the counts' maxima in place of flow facts).
// Cost:     k_loops_max products a node; constexpr.
// Accuracy: rounded up to whole nanoseconds. It is as good as the table: whoever made the table
//           says how in the board file, and the bound names the table by its hash.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string_view>

#include "graph/loops.hpp"

namespace glint {

// One kernel's costs, loop by loop in the order of its node's k_loops, in picoseconds a count.
struct KernelCost {
  std::string_view kernel;  // its node's name: "FindBlobs"
  std::array<std::string_view, graph::k_loops_max> loops{};
  std::array<std::int64_t, graph::k_loops_max> cost_ps{};
};

// A board's costs. A table made at compile time by the generator, or views into a board file read
// at run time.
struct CostTable {
  std::string_view board;
  std::string_view build;   // compiler, its version and the flags that the costs hold for
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
