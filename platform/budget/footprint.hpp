// Static memory of a graph by node, computed from its type.
//
// The state of a node is its object, with all copies of a split. Its tokens are those that it
// writes, with both buffers of a fed-back token. Tokens written from outside belong to no node:
// `inputs_bytes`. The rest of sizeof(G) is padding.
#pragma once

#include <array>
#include <cstddef>
#include <string_view>

#include "graph/graph.hpp"

namespace glint {

struct NodeFootprint {
  std::string_view name;
  int copies = 1;
  std::size_t state_bytes = 0;
  std::size_t token_bytes = 0;
};

namespace detail {

template <class Wires, class... Token>
[[nodiscard]] consteval auto token_sizes(graph::TypeList<Token...> /*tokens*/) {
  return std::array<std::size_t, sizeof...(Token)>{
      sizeof(graph::detail::TokenSlot<Token, Wires::template fed_back<Token>>)...};
}
template <class... Listed>
[[nodiscard]] consteval auto state_sizes(graph::TypeList<Listed...> /*nodes*/) {
  return std::array<std::size_t, sizeof...(Listed)>{sizeof(graph::detail::NodeSlot<Listed>)...};
}

}  // namespace detail

template <class G>
struct Footprint {
  using Wires = typename G::Wires;
  static constexpr std::size_t total_bytes = sizeof(G);

  // In the order of execution; the copies of a split in one row.
  static constexpr std::array<NodeFootprint, Wires::unit_count> nodes = [] {
    std::array<NodeFootprint, Wires::unit_count> rows{};
    constexpr auto names = graph::detail::unit_names(typename Wires::Listed{});
    constexpr auto states = detail::state_sizes(typename Wires::Listed{});
    constexpr auto tokens = detail::token_sizes<Wires>(typename Wires::Tokens{});
    for (int step = 0; step < Wires::unit_count; ++step) {
      const int unit = Wires::order.units[step];
      rows[step] = {names[unit], Wires::copies[unit], states[unit], 0};
      for (int token = 0; token < Wires::token_count; ++token) {
        if (Wires::writer[token] == unit) rows[step].token_bytes += tokens[token];
      }
    }
    return rows;
  }();

  static constexpr std::size_t inputs_bytes = [] {
    std::size_t bytes = 0;
    constexpr auto tokens = detail::token_sizes<Wires>(typename Wires::Tokens{});
    for (int token = 0; token < Wires::token_count; ++token) {
      if (Wires::writer[token] < 0) bytes += tokens[token];
    }
    return bytes;
  }();
};

}  // namespace glint
