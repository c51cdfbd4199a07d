// Description of a graph: nodes in execution order, edges, and a signature that changes with the
// wiring. All are constants of the graph's type, equal on g++ and clang++.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "graph/type_name.hpp"
#include "graph/wiring.hpp"

namespace glint::graph {

enum class EdgeKind : std::uint8_t { token, latest, parts, previous };

// One node; each copy of a split is a separate entry. Indexed by number in the execution order.
struct NodeInfo {
  std::string_view name;
  int copy = 0;
  int copies = 1;
  int level = 0;  // nodes of one level may run in parallel
};

// One edge; for a split the numbers are those of its first copy. -1: outside the graph.
struct EdgeInfo {
  int from = -1;
  int to = -1;
  std::string_view token;
  EdgeKind kind = EdgeKind::token;
};

namespace detail {

template <class Token>
struct TokenInfo {
  static constexpr std::string_view name = type_name<Token>();
  static constexpr EdgeKind kind = EdgeKind::token;
  static constexpr int count = 1;
};
template <class T>
struct TokenInfo<Latest<T>> : TokenInfo<T> {
  static constexpr EdgeKind kind = EdgeKind::latest;
};
template <class T, int N>
struct TokenInfo<Parts<T, N>> : TokenInfo<T> {
  static constexpr EdgeKind kind = EdgeKind::parts;
  static constexpr int count = N;
};

struct TokenRow {
  std::string_view name;
  EdgeKind kind = EdgeKind::token;
  int count = 1;
};
template <class... Token>
[[nodiscard]] consteval std::array<TokenRow, sizeof...(Token)> token_rows(TypeList<Token...>) {
  return {TokenRow{TokenInfo<Token>::name, TokenInfo<Token>::kind, TokenInfo<Token>::count}...};
}
template <class... Listed>
[[nodiscard]] consteval auto unit_names(TypeList<Listed...>) {
  return std::array<std::string_view, sizeof...(Listed)>{
      type_name<typename Unit<Listed>::Node>()...};
}

// 64-bit FNV-1a, http://www.isthe.com/chongo/tech/comp/fnv/: offset basis and prime from there.
class Fnv {
 public:
  constexpr void add(std::string_view text) {
    for (const char c : text) add(static_cast<unsigned char>(c));
    add(0u);  // so that "ab","c" and "a","bc" differ
  }
  constexpr void add(unsigned byte) { hash_ = (hash_ ^ (byte & 0xFFu)) * 0x100000001B3u; }
  [[nodiscard]] constexpr std::uint64_t hash() const { return hash_; }

 private:
  std::uint64_t hash_ = 0xCBF29CE484222325u;
};

}  // namespace detail

template <class G>
struct Description {
  using Wires = typename G::Wires;

  static constexpr std::array<NodeInfo, Wires::node_count> nodes = [] {
    std::array<NodeInfo, Wires::node_count> infos{};
    constexpr auto names = detail::unit_names(typename Wires::Listed{});
    for (int unit = 0; unit < Wires::unit_count; ++unit) {
      for (int copy = 0; copy < Wires::copies[unit]; ++copy) {
        infos[Wires::first_node[unit] + copy] = {names[unit], copy, Wires::copies[unit],
                                                 Wires::order.level[unit]};
      }
    }
    return infos;
  }();

  // Ordered by the reading node and, within it, by its parameters; outputs come last.
  static constexpr int edge_count = [] {
    int count = Wires::OutputTokens::size;
    for (const PortRow& port : Wires::ports) {
      count += port.kind == PortKind::read || port.kind == PortKind::previous ? 1 : 0;
    }
    return count;
  }();
  static constexpr std::array<EdgeInfo, edge_count> edges = [] {
    std::array<EdgeInfo, edge_count> infos{};
    constexpr auto tokens = detail::token_rows(typename Wires::Tokens{});
    int edge = 0;
    const auto node_of = [](int unit) { return unit < 0 ? -1 : Wires::first_node[unit]; };
    for (const int unit : Wires::order.units) {
      for (const PortRow& port : Wires::ports) {
        if (port.unit != unit) continue;
        if (port.kind != PortKind::read && port.kind != PortKind::previous) continue;
        infos[edge++] = {
            node_of(Wires::writer[port.token]), node_of(unit), tokens[port.token].name,
            port.kind == PortKind::previous ? EdgeKind::previous : tokens[port.token].kind};
      }
    }
    const auto add_outputs = [&]<class... Token>(TypeList<Token...>) {
      ((infos[edge++] = {node_of(Wires::writer[index_of<Token>(typename Wires::Tokens{})]), -1,
                         detail::TokenInfo<Token>::name, detail::TokenInfo<Token>::kind}),
       ...);
    };
    add_outputs(typename Wires::OutputTokens{});
    return infos;
  }();

  // Identifies the graph of a plan or a recording: names, copies and ports in execution order.
  static constexpr std::uint64_t signature = [] {
    detail::Fnv fnv;
    constexpr auto names = detail::unit_names(typename Wires::Listed{});
    constexpr auto tokens = detail::token_rows(typename Wires::Tokens{});
    for (const int unit : Wires::order.units) {
      fnv.add(names[unit]);
      fnv.add(static_cast<unsigned>(Wires::copies[unit]));
      for (const PortRow& port : Wires::ports) {
        if (port.unit != unit || port.kind == PortKind::partition) continue;
        fnv.add(static_cast<unsigned>(port.kind));
        fnv.add(static_cast<unsigned>(tokens[port.token].kind));
        fnv.add(static_cast<unsigned>(tokens[port.token].count));
        fnv.add(tokens[port.token].name);
      }
    }
    for (const EdgeInfo& edge : edges) {
      if (edge.from >= 0 && edge.to >= 0) continue;
      fnv.add(edge.from < 0 ? "in" : "out");
      fnv.add(edge.token);
    }
    return fnv.hash();
  }();
};

}  // namespace glint::graph
