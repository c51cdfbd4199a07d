// Compile-time list of the kernels of some graphs and their loops, as a cost table must name them.
//
// What:  each node type once, in the order of execution, independent of its number of copies.
// Cost:  none at run time; a node without a budget is a compile error that names it.
#pragma once

#include <array>
#include <span>
#include <string_view>

#include "graph/graph.hpp"
#include "graph/loops.hpp"
#include "kernels/limits.hpp"

namespace glint {

struct KernelLoops {
  std::string_view kernel;
  std::span<const std::string_view> loops;
};

template <class Node, bool holds>
struct NodeWithoutBudget {
  static_assert(holds, "this node names no loops: it needs k_loops, worst(limits) and counts()");
};

namespace detail {

template <class Listed>
[[nodiscard]] consteval KernelLoops loops_of() {
  using Node = typename graph::Unit<Listed>::Node;
  (void)sizeof(NodeWithoutBudget<Node, graph::Budgeted<Node, Limits>>);
  return {graph::type_name<Node>(), Node::k_loops};
}

template <class... Listed>
[[nodiscard]] consteval auto listed_loops(graph::TypeList<Listed...> /*units*/) {
  return std::array<KernelLoops, sizeof...(Listed)>{loops_of<Listed>()...};
}

}  // namespace detail

// In the order in which the graphs list them; a node of two graphs occurs once for each.
template <class... G>
inline constexpr auto kernels_of =
    detail::listed_loops(graph::Join<typename G::Wires::Listed...>{});

}  // namespace glint
