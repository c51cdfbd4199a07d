// Derives a node's interface from the signature of its call operator.
#pragma once

#include <type_traits>

#include "graph/latest.hpp"
#include "graph/port.hpp"
#include "graph/type_list.hpp"

namespace glint::graph {

enum class PortKind { read, write, previous, partition, wrong };

// Kind and token of one parameter of a call operator. Kind `wrong`: by value (except Partition), by
// pointer, by rvalue reference, or a read-only graph type by T&.
template <class Parameter>
struct Port {
  static constexpr PortKind kind = PortKind::wrong;
  using Token = Parameter;
};
template <class T>
struct Port<T&> {
  static constexpr PortKind kind =
      std::is_const_v<T> || std::is_volatile_v<T> ? PortKind::wrong : PortKind::write;
  using Token = T;
};
template <class T>
struct Port<const T&> {
  static constexpr PortKind kind = std::is_volatile_v<T> ? PortKind::wrong : PortKind::read;
  using Token = T;
};
template <class T>
struct Port<const Previous<T>&> {
  static constexpr PortKind kind = PortKind::previous;
  using Token = T;
};
template <>
struct Port<Partition> {
  static constexpr PortKind kind = PortKind::partition;
  using Token = Partition;
};
template <class T>
struct Port<Previous<T>&> : Port<Previous<T>> {};
template <class T>
struct Port<Latest<T>&> : Port<Latest<T>> {};
template <class T, int N>
struct Port<Parts<T, N>&> : Port<Parts<T, N>> {};
template <>
struct Port<Partition&> {
  static constexpr PortKind kind = PortKind::wrong;
  using Token = Partition;
};
template <>
struct Port<const Partition&> : Port<Partition&> {};

namespace detail {

template <class Call>
struct CallOf {
  static constexpr bool fits = false;
  using Parameters = TypeList<>;
};
template <class Node, class... P>
struct CallOf<void (Node::*)(P...) noexcept> {
  static constexpr bool fits = true;
  using Parameters = TypeList<P...>;
};
template <class Node, class... P>
struct CallOf<void (Node::*)(P...) const noexcept> : CallOf<void (Node::*)(P...) noexcept> {};
#if defined(__has_cpp_attribute)
#if __has_cpp_attribute(clang::nonblocking)
// Compilers with this attribute make it part of a call operator's type.
template <class Node, class... P>
struct CallOf<void (Node::*)(P...) noexcept [[clang::nonblocking]]>
    : CallOf<void (Node::*)(P...) noexcept>{};
template <class Node, class... P>
struct CallOf<void (Node::*)(P...) const noexcept [[clang::nonblocking]]>
    : CallOf<void (Node::*)(P...) noexcept>{};
#endif
#endif

template <class Node>
struct SignatureOf : CallOf<void> {};
template <class Node>
requires requires { &Node::operator(); }
struct SignatureOf<Node> : CallOf<decltype(&Node::operator())> {};

}  // namespace detail

// One entry of a graph's list of nodes: a node, or the copies of a split node.
template <class Listed>
struct Unit {
  using Node = Listed;
  static constexpr int count = 1;
  static constexpr bool split = false;
  template <class T>
  using Written = T;
};
template <class SplitNode, int N>
struct Unit<Split<SplitNode, N>> {
  using Node = SplitNode;
  static constexpr int count = N;
  static constexpr bool split = true;
  template <class T>
  using Written = Parts<T, N>;
};

// True if the node has one call operator `void operator()(...) noexcept`; and its parameters.
template <class Listed>
inline constexpr bool callable = detail::SignatureOf<typename Unit<Listed>::Node>::fits;
template <class Listed>
using Parameters = typename detail::SignatureOf<typename Unit<Listed>::Node>::Parameters;

namespace detail {

template <class Listed, class Parameter, PortKind kind>
struct PortToken {
  using Type = typename Port<Parameter>::Token;
};
template <class Listed, class Parameter>
struct PortToken<Listed, Parameter, PortKind::write> {
  using Type = typename Unit<Listed>::template Written<typename Port<Parameter>::Token>;
};

template <class Listed, class List>
struct PortTokens;
template <class Listed, class... P>
struct PortTokens<Listed, TypeList<P...>> {
  using Type = TypeList<typename PortToken<Listed, P, Port<P>::kind>::Type...>;
};

}  // namespace detail

// The graph's token for each parameter: Parts<T, N> where a split writes T.
template <class Listed, class Parameter>
using TokenOf = typename detail::PortToken<Listed, Parameter, Port<Parameter>::kind>::Type;
template <class Listed>
using TokensOf = typename detail::PortTokens<Listed, Parameters<Listed>>::Type;

}  // namespace glint::graph
