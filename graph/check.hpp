// Compile-time checks of a graph's rules. The name and arguments of each template are the message:
// the compiler prints `NoWriter<Blobs, CountBlobs, false>` and the sentence.
#pragma once

#include "graph/wiring.hpp"

namespace glint::graph {

template <class Node, bool holds>
struct NotANode {
  static_assert(holds, "a node has exactly one call operator: void operator()(...) noexcept");
};
template <class Node, bool holds>
struct ListedTwice {
  static_assert(holds, "a graph lists each node type once");
};
template <class Node, class Parameter, bool holds>
struct WrongType {
  static_assert(holds,
                "a node's parameter is const T&, T&, const Previous<T>&, const Latest<T>&, "
                "const Parts<T, N>&, or under Split also Partition");
};
template <class Node, bool holds>
struct PartitionOutsideSplit {
  static_assert(holds, "only a node under Split takes a Partition");
};
template <class Token, class Reader, bool holds>
struct NoWriter {
  static_assert(holds, "this token is read, but no node writes it and Inputs does not list it");
};
template <class Token, bool holds>
struct OutputNeverWritten {
  static_assert(holds, "Outputs lists this token, but no node writes it");
};
template <class Token, bool holds>
struct TwoWriters {
  static_assert(holds, "this token has more than one writer (Inputs counts as one)");
};
template <class Token, class Reader, bool holds>
struct WrongPartsCount {
  static_assert(holds, "these parts are read, but their split has another count");
};
template <class Token, bool holds>
struct PreviousOfInput {
  static_assert(holds, "Previous<> reads a node's output; the caller stores previous inputs");
};
template <class Token, class Node, bool holds>
struct Cycle {
  static_assert(holds, "this token depends on itself; use Previous<> for feedback");
};

namespace detail {

// True for two tokens that are parts of one type with different counts.
template <class A, class B>
inline constexpr bool differ_in_count = false;
template <class T, int N, int M>
inline constexpr bool differ_in_count<Parts<T, N>, Parts<T, M>> = N != M;

template <class Wires, class Token, class... Other>
[[nodiscard]] consteval bool written_with_other_count(TypeList<Other...> /*tokens*/) {
  return ((differ_in_count<Token, Other> && Wires::template count_of<Other>(PortKind::write) > 0) ||
          ...);
}

template <class Wires, class Listed, class Parameter>
consteval void check_parameter() {
  using Node = typename Unit<Listed>::Node;
  using Token = TokenOf<Listed, Parameter>;
  constexpr PortKind kind = Port<Parameter>::kind;
  (void)sizeof(WrongType<Node, Parameter, kind != PortKind::wrong>);
  if constexpr (kind == PortKind::partition) {
    (void)sizeof(PartitionOutsideSplit<Node, Unit<Listed>::split>);
  }
  if constexpr (kind == PortKind::read || kind == PortKind::previous) {
    constexpr bool written = Wires::template count_of<Token>(PortKind::write) > 0;
    constexpr bool is_graph_input = Wires::template is_input<Token>;
    if constexpr (!written) {
      constexpr bool other = written_with_other_count<Wires, Token>(typename Wires::Tokens{});
      (void)sizeof(WrongPartsCount<Token, Node, !other>);
      constexpr bool found = is_graph_input || other;
      (void)sizeof(NoWriter<Token, Node, found>);
    }
    constexpr bool remembers_input = kind == PortKind::previous && is_graph_input;
    (void)sizeof(PreviousOfInput<Token, !remembers_input>);
  }
}

template <class Wires, class Listed, class... Parameter>
consteval void check_node(TypeList<Parameter...> /*parameters*/) {
  (void)sizeof(NotANode<typename Unit<Listed>::Node, callable<Listed>>);
  (check_parameter<Wires, Listed, Parameter>(), ...);
}

template <class Wires, class Token>
consteval void check_token() {
  constexpr int writers = Wires::template count_of<Token>(PortKind::write);
  (void)sizeof(TwoWriters<Token, writers + (Wires::template is_input<Token> ? 1 : 0) <= 1>);
}

template <class Wires, class... Token>
consteval void check_tokens(TypeList<Token...> /*tokens*/) {
  (check_token<Wires, Token>(), ...);
}

template <class Wires, class... Token>
consteval void check_outputs(TypeList<Token...> /*outputs*/) {
  ((void)sizeof(OutputNeverWritten<Token, Wires::template count_of<Token>(PortKind::write) != 0>),
   ...);
}

template <class Wires>
consteval void check_order() {
  if constexpr (Wires::order.placed < Wires::unit_count) {
    (void)sizeof(
        Cycle<At<Wires::order.cycle_token, typename Wires::Tokens>,
              typename Unit<At<Wires::order.cycle_unit, typename Wires::Listed>>::Node, false>);
  }
}

template <class Node, class... Listed>
consteval void check_once() {
  constexpr int times = (static_cast<int>(std::is_same_v<Node, typename Unit<Listed>::Node>) + ...);
  (void)sizeof(ListedTwice<Node, times == 1>);
}

// True; a rule that does not hold is a compile error.
template <class Wires, class... Listed>
[[nodiscard]] consteval bool check_graph() {
  static_assert(sizeof...(Listed) > 0, "a graph has at least one node");
  (check_once<typename Unit<Listed>::Node, Listed...>(), ...);
  (check_node<Wires, Listed>(Parameters<Listed>{}), ...);
  check_tokens<Wires>(typename Wires::Tokens{});
  check_outputs<Wires>(typename Wires::OutputTokens{});
  check_order<Wires>();
  return true;
}

}  // namespace detail

}  // namespace glint::graph
