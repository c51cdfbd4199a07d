// Four trivial nodes, as a graph with its list in the wrong order and as a chain of calls.
//
// The bodies may be inlined, as a graph's bodies that the compiler sees; or not, as a kernel in
// another file. In the second case the rest of a node's cost is its call.
#pragma once

#include <array>

#include "graph/graph.hpp"

namespace glint::bench {

inline constexpr int k_dispatch_nodes = 4;

struct A {
  int value = 0;
};
struct B {
  int value = 0;
};
struct C {
  int value = 0;
};
struct D {
  int value = 0;
};
struct E {
  int value = 0;
};

struct MakeB {
  void operator()(const A& a, B& b) const noexcept { b.value = a.value + 1; }
};
struct MakeC {
  void operator()(const B& b, C& c) const noexcept { c.value = b.value ^ 2; }
};
struct MakeD {
  void operator()(const B& b, const C& c, D& d) const noexcept { d.value = b.value + c.value; }
};
struct MakeE {
  void operator()(const D& d, const graph::Previous<E>& last, E& e) const noexcept {
    e.value = last.value().value + d.value;
  }
};

struct CallB {
  [[gnu::noinline]] void operator()(const A& a, B& b) const noexcept { MakeB{}(a, b); }
};
struct CallC {
  [[gnu::noinline]] void operator()(const B& b, C& c) const noexcept { MakeC{}(b, c); }
};
struct CallD {
  [[gnu::noinline]] void operator()(const B& b, const C& c, D& d) const noexcept {
    MakeD{}(b, c, d);
  }
};
struct CallE {
  [[gnu::noinline]] void operator()(const D& d, const graph::Previous<E>& last,
                                    E& e) const noexcept {
    MakeE{}(d, last, e);
  }
};

template <class NodeB, class NodeC, class NodeD, class NodeE>
using GraphOf = graph::Graph<graph::Inputs<A>, graph::Outputs<E>, NodeE, NodeC, NodeD, NodeB>;
using InlinedGraph = GraphOf<MakeB, MakeC, MakeD, MakeE>;
using CalledGraph = GraphOf<CallB, CallC, CallD, CallE>;
static_assert(graph::valid<InlinedGraph> && InlinedGraph::node_count == k_dispatch_nodes);
static_assert(graph::valid<CalledGraph>);

// The hand-written equivalent: the same tokens in the same order without a graph.
template <class NodeB, class NodeC, class NodeD, class NodeE>
struct Chain {
  A a;
  B b;
  C c;
  D d;
  std::array<E, 2> e;
  unsigned now = 0;

  void activate() noexcept {
    now ^= 1u;
    NodeB{}(a, b);
    NodeC{}(b, c);
    NodeD{}(b, c, d);
    NodeE{}(d, graph::Previous<E>(e[now ^ 1u]), e[now]);
  }
};
using InlinedChain = Chain<MakeB, MakeC, MakeD, MakeE>;
using CalledChain = Chain<CallB, CallC, CallD, CallE>;

}  // namespace glint::bench
