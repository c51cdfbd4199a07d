// Wiring of a graph at compile time from its nodes' signatures: writer of each token, topological
// order of the nodes, and levels.
#pragma once

#include <algorithm>
#include <array>

#include "graph/signature.hpp"
#include "graph/type_list.hpp"

namespace glint::graph {

// One parameter of one listed node. Tokens and nodes are indices in their lists.
struct PortRow {
  int unit = 0;
  PortKind kind = PortKind::wrong;
  int token = 0;
};

// A topological order of n nodes; ties go to the node that is listed first.
template <int n>
struct Order {
  std::array<int, n> units{};  // in execution order
  std::array<int, n> level{};  // of each listed node: 1 + the highest level it reads from
  int placed = 0;              // less than n: the others wait on a cycle
  int levels = 0;
  int cycle_unit = -1;  // a node on that cycle, and the token that it waits for
  int cycle_token = -1;
};

// writer[t] is the node that writes token t, or -1.
template <int n, std::size_t ports_size, std::size_t tokens_size>
[[nodiscard]] consteval Order<n> sort_units(const std::array<PortRow, ports_size>& ports,
                                            const std::array<int, tokens_size>& writer) {
  Order<n> order;
  std::array<bool, n> done{};
  const auto waits_for = [&](int unit) {
    for (const PortRow& port : ports) {
      if (port.unit != unit || port.kind != PortKind::read) continue;
      const int from = writer[port.token];
      if (from >= 0 && !done[from]) return port.token;
    }
    return -1;
  };
  for (int step = 0; step < n; ++step) {
    int next = -1;
    for (int unit = 0; unit < n && next < 0; ++unit) {
      if (!done[unit] && waits_for(unit) < 0) next = unit;
    }
    if (next < 0) break;
    for (const PortRow& port : ports) {
      if (port.unit != next || port.kind != PortKind::read || writer[port.token] < 0) continue;
      order.level[next] = std::max(order.level[next], order.level[writer[port.token]] + 1);
    }
    order.levels = std::max(order.levels, order.level[next] + 1);
    order.units[order.placed++] = next;
    done[next] = true;
  }
  if (order.placed < n) {
    // A waiting node may be only downstream of the cycle; n steps upstream always reach it.
    int unit = 0;
    while (done[unit]) ++unit;
    for (int step = 0; step < n; ++step) unit = writer[waits_for(unit)];
    order.cycle_unit = unit;
    order.cycle_token = waits_for(unit);
    for (int remaining = 0, at = order.placed; remaining < n; ++remaining) {
      if (!done[remaining]) order.units[at++] = remaining;
    }
  }
  return order;
}

namespace detail {

template <class In>
struct ListOf;
template <class... T>
struct ListOf<Inputs<T...>> {
  using Type = TypeList<T...>;
};
template <class... T>
struct ListOf<Outputs<T...>> {
  using Type = TypeList<T...>;
};

}  // namespace detail

template <class In, class Out, class... Nodes>
struct Wiring {
  using Listed = TypeList<Nodes...>;
  using InputTokens = typename detail::ListOf<In>::Type;
  using OutputTokens = typename detail::ListOf<Out>::Type;
  using Tokens = Unique<Join<InputTokens, TokensOf<Nodes>..., OutputTokens>>;

  static constexpr int unit_count = sizeof...(Nodes);
  static constexpr int node_count = (Unit<Nodes>::count + ... + 0);
  static constexpr int token_count = Tokens::size;
  static constexpr int port_count = (Parameters<Nodes>::size + ... + 0);

  static constexpr std::array<PortRow, port_count> ports = [] {
    std::array<PortRow, port_count> rows{};
    int unit = 0;
    int row = 0;
    const auto add = [&]<class Node, class... P>(std::type_identity<Node>, TypeList<P...>) {
      ((rows[row++] = {unit, Port<P>::kind, index_of<TokenOf<Node, P>>(Tokens{})}), ...);
      ++unit;
    };
    (add(std::type_identity<Nodes>{}, Parameters<Nodes>{}), ...);
    return rows;
  }();

  // Writer of each token; -1 for an input and for a token without a writer.
  static constexpr std::array<int, token_count> writer = [] {
    std::array<int, token_count> units{};
    units.fill(-1);
    for (const PortRow& port : ports) {
      if (port.kind == PortKind::write && units[port.token] < 0) units[port.token] = port.unit;
    }
    return units;
  }();

  static constexpr Order<unit_count> order = sort_units<unit_count>(ports, writer);

  static constexpr std::array<int, unit_count> copies = {Unit<Nodes>::count...};

  // Number of the first copy of each listed node, in execution order.
  static constexpr std::array<int, unit_count> first_node = [] {
    std::array<int, unit_count> first{};
    int number = 0;
    for (const int unit : order.units) {
      first[unit] = number;
      number += copies[unit];
    }
    return first;
  }();

  // Number of parameters of all nodes that use the token with this kind.
  template <class Token>
  [[nodiscard]] static consteval int count_of(PortKind kind) {
    int count = 0;
    for (const PortRow& port : ports) {
      count += port.kind == kind && port.token == index_of<Token>(Tokens{}) ? 1 : 0;
    }
    return count;
  }
  template <class Token>
  static constexpr bool is_input = index_of<Token>(InputTokens{}) >= 0;
  template <class Token>
  static constexpr bool fed_back = count_of<Token>(PortKind::previous) > 0;
};

}  // namespace glint::graph
