// Compile-time schedulability test: do all chains meet their deadlines on a board?
//
//   struct FrameChain {                      // the chain's name in the message
//     using Graph = Tracker;
//     static constexpr std::int64_t deadline_ns = 22'222'222;
//     static constexpr std::int64_t gap_ns = 22'222'222;  // between releases, at least
//   };
//   static_assert(meets_deadlines<board::k_table, Limits{}, TickChain, FrameChain>);
//
// What:     chains on one core, in order of decreasing priority. Each runs its nodes in the graph's
//           order, at their bounds, and is preempted by the chains before it. A missed deadline is
//           a compile error that names the chain, the node in which the deadline passes, and the
//           overshoot in nanoseconds: ChainMissesDeadline<FrameChain, FindBlobs, 12345, false>.
// Cost:     none at run time.
// Accuracy: as response_time.hpp. Excludes the operating system's share (an estimate) and other
//           cores; `glint budget check` adds them.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "schedules/node_bounds.hpp"
#include "schedules/response_time.hpp"

namespace glint {

template <class Chain, class Node, std::int64_t overshoot_ns, bool holds>
struct ChainMissesDeadline {
  static_assert(
      holds, "on this board the chain may miss its deadline in this node, by so many nanoseconds");
};
template <class Node, bool holds>
struct NodeWithoutCost {
  static_assert(holds, "the board's table has no costs for this node's loops: measure again");
};

namespace detail {

// Index of the listed node that contains this node of the execution order.
template <class Wires>
[[nodiscard]] consteval int unit_of(int node) {
  for (int unit = 0; unit < Wires::unit_count; ++unit) {
    const int first = Wires::first_node[static_cast<std::size_t>(unit)];
    const int copies = Wires::copies[static_cast<std::size_t>(unit)];
    if (node >= first && node < first + copies) return unit;
  }
  return 0;
}

template <class Wires, int node>
using NodeAt = typename graph::Unit<graph::At<unit_of<Wires>(node), typename Wires::Listed>>::Node;

struct ChainEnd {
  int late_node = -1;  // the first node that may end after the deadline
  std::int64_t overshoot_ns = 0;
};

template <std::size_t n>
[[nodiscard]] consteval ChainEnd chain_end(const std::array<std::int64_t, n>& bounds,
                                           std::span<const Interference> higher,
                                           std::int64_t deadline_ns) {
  ChainEnd end;
  std::int64_t base = 0;
  for (std::size_t node = 0; node < n; ++node) {
    base += bounds[node];
    int steps = k_response_steps_max;
    const auto window = busy_window(base, higher, k_busy_period_max_ns, base, steps);
    const std::int64_t response = window ? *window : k_busy_period_max_ns;
    if (response <= deadline_ns) continue;
    if (end.late_node < 0) end.late_node = static_cast<int>(node);
    end.overshoot_ns = response - deadline_ns;
  }
  return end;
}

template <const CostTable& table, class Wires, int... unit>
[[nodiscard]] consteval bool check_costs(std::integer_sequence<int, unit...> /*units*/) {
  ((void)sizeof(NodeWithoutCost<
                typename graph::Unit<graph::At<unit, typename Wires::Listed>>::Node,
                node_bound<typename graph::Unit<graph::At<unit, typename Wires::Listed>>::Node>(
                    table, Limits{}) != k_no_bound>),
   ...);
  return true;
}

template <const CostTable& table, Limits limits, class G>
[[nodiscard]] consteval std::int64_t sum_of_bounds() {
  std::int64_t sum = 0;
  for (const std::int64_t bound : node_bounds<G>(table, limits)) sum += bound;
  return sum;
}

// One chain, preempted by all chains before it in the list.
template <const CostTable& table, Limits limits, class Chain, class... Higher>
[[nodiscard]] consteval bool check_chain(graph::TypeList<Higher...> /*higher*/) {
  using G = typename Chain::Graph;
  (void)check_costs<table, typename G::Wires>(std::make_integer_sequence<int, G::unit_count>{});
  constexpr std::array<Interference, sizeof...(Higher)> higher = {
      Interference{sum_of_bounds<table, limits, typename Higher::Graph>(), Higher::gap_ns, 0}...};
  constexpr ChainEnd end = chain_end(node_bounds<G>(table, limits), higher, Chain::deadline_ns);
  if constexpr (end.late_node >= 0) {
    (void)sizeof(ChainMissesDeadline<Chain, NodeAt<typename G::Wires, end.late_node>,
                                     end.overshoot_ns, false>);
  }
  return end.late_node < 0;
}

template <const CostTable& table, Limits limits, class... Before>
[[nodiscard]] consteval bool check_chains(graph::TypeList<Before...> /*done*/,
                                          graph::TypeList<> /*rest*/) {
  return true;
}
template <const CostTable& table, Limits limits, class... Before, class Chain, class... Rest>
[[nodiscard]] consteval bool check_chains(graph::TypeList<Before...> done,
                                          graph::TypeList<Chain, Rest...> /*rest*/) {
  const bool holds = check_chain<table, limits, Chain>(done);
  return check_chains<table, limits>(graph::TypeList<Before..., Chain>{},
                                     graph::TypeList<Rest...>{}) &&
         holds;
}

}  // namespace detail

template <const CostTable& table, Limits limits, class... Chain>
inline constexpr bool meets_deadlines =
    detail::check_chains<table, limits>(graph::TypeList<>{}, graph::TypeList<Chain...>{});

}  // namespace glint
