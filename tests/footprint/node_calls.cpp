#include "tests/footprint/node_calls.hpp"

#include <array>
#include <utility>

namespace glint::footprint {
namespace {

// The call graph names this function with its Node, which identifies the node's bound.
template <class G, class Node, int unit>
[[gnu::noinline]] void call_node(G& graph) noexcept {
  graph::NoTrace trace;
  graph::for_each_index<G::Wires::copies[unit]>(
      [&]<int copy>() { graph.template call<unit, copy>(trace); });
}

template <class G, int step>
[[nodiscard]] consteval NodeCall<G> call_of_step() {
  constexpr int unit = G::Wires::order.units[step];
  using Node = typename graph::Unit<graph::At<unit, typename G::Wires::Listed>>::Node;
  return {graph::type_name<Node>(), &call_node<G, Node, unit>};
}

template <class G>
[[nodiscard]] consteval auto calls_of() {
  return []<int... step>(std::integer_sequence<int, step...>) {
    return std::array<NodeCall<G>, sizeof...(step)>{call_of_step<G, step>()...};
  }
  (std::make_integer_sequence<int, G::unit_count>{});
}

constexpr auto k_tracker_calls = calls_of<Tracker>();
constexpr auto k_output_calls = calls_of<Output>();

}  // namespace

std::span<const NodeCall<Tracker>> tracker_calls() { return k_tracker_calls; }
std::span<const NodeCall<Output>> output_calls() { return k_output_calls; }

[[gnu::noinline]] void activate_tracker(Tracker& graph) noexcept { graph.activate(); }
[[gnu::noinline]] void activate_output(Output& graph) noexcept { graph.activate(); }

}  // namespace glint::footprint
