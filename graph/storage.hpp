// Storage of a graph's tokens and nodes inside the graph object; its size is the memory footprint.
#pragma once

#include <array>
#include <cassert>

#include "graph/signature.hpp"
#include "graph/type_list.hpp"

namespace glint::graph::detail {

// A token: double-buffered if a Previous<> reads it, else one buffer.
template <class Token, bool fed_back>
class TokenSlot {
 public:
  void begin_activation() noexcept {}
  void abandon_activation() noexcept {}
  [[nodiscard]] Token& now() noexcept { return value_; }
  [[nodiscard]] const Token& now() const noexcept { return value_; }

 private:
  Token value_{};
};

template <class Token>
class TokenSlot<Token, true> {
 public:
  void begin_activation() noexcept { current_ ^= 1; }
  void abandon_activation() noexcept { current_ ^= 1; }
  [[nodiscard]] Token& now() noexcept { return values_[current_]; }
  [[nodiscard]] const Token& now() const noexcept { return values_[current_]; }
  [[nodiscard]] const Token& before() const noexcept { return values_[current_ ^ 1]; }

 private:
  Token values_[2]{};
  int current_ = 0;
};

// All tokens; the type selects the slot at compile time.
template <class Token, bool fed_back>
struct NamedSlot {
  TokenSlot<Token, fed_back> slot;
};

template <class Wires, class Tokens>
struct TokenStore;
template <class Wires, class... Token>
struct TokenStore<Wires, TypeList<Token...>>
    : NamedSlot<Token, Wires::template fed_back<Token>>... {
  template <class T>
  [[nodiscard]] auto& slot() noexcept {
    return static_cast<NamedSlot<T, Wires::template fed_back<T>>&>(*this).slot;
  }
  template <class T>
  [[nodiscard]] const auto& slot() const noexcept {
    return static_cast<const NamedSlot<T, Wires::template fed_back<T>>&>(*this).slot;
  }
  void begin_activation() noexcept { (slot<Token>().begin_activation(), ...); }
  void abandon_activation() noexcept { (slot<Token>().abandon_activation(), ...); }
};

// A node, or its copies; each on separate cache lines, because workers write their states.
template <class Listed>
struct NodeSlot {
  struct alignas(k_cache_line) Cell {
    typename Unit<Listed>::Node node{};
  };
  std::array<Cell, Unit<Listed>::count> copies{};
};

template <class... Listed>
struct NodeStore : NodeSlot<Listed>... {};

// Finds Parts<T, N> among a graph's tokens.
template <class T, class Tokens>
struct FindParts;
template <class T, int N, class... Rest>
struct FindParts<T, TypeList<Parts<T, N>, Rest...>> {
  using Type = Parts<T, N>;
};
template <class T, class First, class... Rest>
struct FindParts<T, TypeList<First, Rest...>> : FindParts<T, TypeList<Rest...>> {};
template <class T, class Tokens>
using PartsIn = typename FindParts<T, Tokens>::Type;

// The listed entry of a node type.
template <class Node, class... Listed>
struct EntryOf {
  static constexpr int index = index_of<Node>(TypeList<typename Unit<Listed>::Node...>{});
  static_assert(index >= 0, "this graph has no such node");
  using Type = At<index, TypeList<Listed...>>;
};

}  // namespace glint::graph::detail
