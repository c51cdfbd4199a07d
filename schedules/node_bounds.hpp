// What each node of a graph may need at worst on a board, under given limits.
//
// What:     bound_ns of the node's declared loop maxima, for every copy of every node.
// Cost:     k_loops_max products a node; constexpr, so that a build can be refused by it.
// Accuracy: that of the table. A node that the table does not know has no bound: it is named by
//           missing_cost, and asking for its bound all the same gives k_no_bound.
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

// Whether the costs are of these loops, in this order, and of no other that costs anything: a table
// of an older kernel is not.
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

// The first node whose loops the table does not price; empty: it prices all.
template <class... G>
[[nodiscard]] constexpr std::string_view missing_cost(const CostTable& table) {
  for (const KernelLoops& kernel : kernels_of<G...>) {
    const KernelCost* cost = table.find(kernel.kernel);
    if (cost == nullptr || !costs_of(*cost, kernel)) return kernel.kernel;
  }
  return {};
}

// What one copy of a node does at most. A node whose copies differ says so by worst(limits, slice).
template <class Node>
[[nodiscard]] constexpr graph::LoopCounts worst_of(const Limits& limits, graph::Slice slice) {
  if constexpr (requires { Node::worst(limits, slice); }) {
    return Node::worst(limits, slice);
  } else {
    return Node::worst(limits);
  }
}

// One node, or one copy of a split one, in nanoseconds.
template <class Node>
[[nodiscard]] constexpr std::int64_t node_bound(const CostTable& table, const Limits& limits,
                                                graph::Slice slice = {}) {
  const KernelLoops kernel{graph::type_name<Node>(), Node::k_loops};
  const KernelCost* cost = table.find(kernel.kernel);
  if (cost == nullptr || !costs_of(*cost, kernel)) return k_no_bound;
  return bound_ns(*cost, worst_of<Node>(limits, slice));
}

// By node number: the order of execution, each copy of a split by itself, as in
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
