// Serial executor, the reference: runs all nodes one after another in the caller's thread.
#pragma once

namespace glint::graph {

// Receives the begin and end of each node; `node` is the number in execution order. Empty calls
// cost nothing.
template <class T>
concept Trace = requires(T& trace, int node) {
  trace.on_node_begin(node);
  trace.on_node_end(node);
};

struct NoTrace {
  void on_node_begin(int /*node*/) noexcept {}
  void on_node_end(int /*node*/) noexcept {}
};

// Runs every node of the graph as an inlined call, in the graph's order.
struct Serial {
  template <class G>
  void execute(G& graph) noexcept {
    NoTrace trace;
    graph.activate(trace);
  }
};

}  // namespace glint::graph
