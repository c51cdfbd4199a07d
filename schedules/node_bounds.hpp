// Worst-case execution time bound of each node of a graph on a board, under given limits.
//
// What:     bound_ns of the node's declared loop maxima, for every copy of every node.
// Cost:     k_loops_max products a node; constexpr, so that a build can fail on it.
// Accuracy: as the table. A node without costs in the table has no bound: missing_cost names it,
//           and its bound is k_no_bound.
// Source:   Li and Malik 1995, eq. (1), as in cost_table.hpp.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "graph/port.hpp"
#include "schedules/cost_table.hpp"
#include "schedules/kernel_list.hpp"

namespace glint {

inline constexpr std::int64_t k_no_bound = -1;

// True if the costs are for exactly these loops, in this order. False for a table of an older
// kernel.
[[nodiscard]] constexpr bool costs_of(const KernelCost& cost, const KernelLoops& kernel) {
  for (std::size_t loop = 0; loop < graph::k_loops_max; ++loop) {
    if (loop >= kernel.loops.size()) {
      if (cost.cost_ps[loop] != 0) return false;
    } else if (cost.loops[loop] != kernel.loops[loop]) {
      return false;
    }
  }
  return true;
}

// Name of the first node without costs in the table; empty if there is none.
template <class... G>
[[nodiscard]] constexpr std::string_view missing_cost(const CostTable& table) {
  for (const KernelLoops& kernel : kernels_of<G...>) {
    const KernelCost* cost = table.find(kernel.kernel);
    if (cost == nullptr || !costs_of(*cost, kernel)) return kernel.kernel;
  }
  return {};
}

// Maximum loop counts of one copy of a node. Nodes with different copies define worst(limits,
// partition).
template <class Node>
[[nodiscard]] constexpr graph::LoopCounts worst_of(const Limits& limits,
                                                   graph::Partition partition) {
  if constexpr (requires { Node::worst(limits, partition); }) {
    return Node::worst(limits, partition);
  } else {
    return Node::worst(limits);
  }
}

// WCET bound of one node, or of one copy of a split node, in nanoseconds.
template <class Node>
[[nodiscard]] constexpr std::int64_t node_bound(const CostTable& table, const Limits& limits,
                                                graph::Partition partition = {}) {
  const KernelLoops kernel{graph::type_name<Node>(), Node::k_loops};
  const KernelCost* cost = table.find(kernel.kernel);
  if (cost == nullptr || !costs_of(*cost, kernel)) return k_no_bound;
  return bound_ns(*cost, worst_of<Node>(limits, partition));
}

// By node index in the order of execution, each copy of a split node separately, as in
// graph::Description<G>::nodes.
template <class G>
[[nodiscard]] constexpr std::array<std::int64_t, static_cast<std::size_t>(G::node_count)>
node_bounds(const CostTable& table, const Limits& limits) {
  using Wires = typename G::Wires;
  std::array<std::int64_t, static_cast<std::size_t>(G::node_count)> bounds{};
  graph::for_each_index<G::unit_count>([&]<int unit>() {
    using Node = typename graph::Unit<graph::At<unit, typename Wires::Listed>>::Node;
    for (int copy = 0; copy < Wires::copies[unit]; ++copy) {
      bounds[static_cast<std::size_t>(Wires::first_node[unit] + copy)] =
          node_bound<Node>(table, limits, {copy, Wires::copies[unit]});
    }
  });
  return bounds;
}

}  // namespace glint
