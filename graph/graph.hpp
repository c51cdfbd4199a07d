// Static dataflow graph, wired at compile time by the signatures of its nodes.
//
//   using Tracker = Graph<Inputs<Frame>, Outputs<Estimates>, Split<RoiThreshold, 2>, FindBlobs,
//   ..>; static_assert(valid<Tracker>);
//
// Nodes may be listed in any order: they run in a topological order found at compile time, ties in
// the order listed. The object contains all tokens and nodes, so it belongs in static memory.
// Cost: an activation is one direct call a node; feedback tokens swap two buffers by an index.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <type_traits>
#include <utility>

#include "graph/check.hpp"
#include "graph/describe.hpp"
#include "graph/executor.hpp"
#include "graph/latest.hpp"
#include "graph/port.hpp"
#include "graph/rate_group.hpp"
#include "graph/ring.hpp"
#include "graph/storage.hpp"
#include "graph/type_name.hpp"
#include "graph/watch.hpp"
#include "graph/wiring.hpp"
#include "graph/workers.hpp"

namespace glint::graph {

// Result of prepare(): the first node whose prepare() failed, and the reason. A node's prepare()
// returns an enumeration whose value 0 means success; `reason` is the value of the failure.
struct Prepared {
  int node = -1;  // number in execution order
  std::string_view name;
  int reason = 0;
  [[nodiscard]] explicit operator bool() const noexcept { return node < 0; }
};

template <class In, class Out, class... Nodes>
class Graph {
 public:
  using Wires = Wiring<In, Out, Nodes...>;
  static_assert(detail::check_graph<Wires, Nodes...>());
  static constexpr int unit_count = Wires::unit_count;  // listed nodes
  static constexpr int node_count = Wires::node_count;  // with every copy of a split
  static constexpr int level_count = Wires::order.levels;
  // True if workers beyond the first have nodes to run.
  static constexpr bool has_split = ((Unit<Nodes>::count > 1) || ...);

  Graph() = default;
  Graph(const Graph&) = delete;
  Graph& operator=(const Graph&) = delete;

  // A node, or copy `index` of a split node. Set its settings here, before prepare().
  template <class Node>
  [[nodiscard]] Node& node(int index = 0) noexcept {
    auto& copies = slot_of<Node>().copies;
    assert(index >= 0 && index < static_cast<int>(copies.size()));
    return copies[static_cast<std::size_t>(index)].node;
  }
  // Calls f(Node&) for the node or for all its copies.
  template <class Node, class F>
  void for_each(F&& f) {
    for (auto& cell : slot_of<Node>().copies) f(cell.node);
  }

  // Input token; the caller writes it before an activation.
  template <class T>
  [[nodiscard]] T& input() noexcept {
    static_assert(Wires::template is_input<T>, "Inputs does not list this token");
    return tokens_.template slot<T>().now();
  }
  template <class T>
  [[nodiscard]] Latest<T>& latest() noexcept {
    return input<Latest<T>>();
  }
  // Output token of the last activation.
  template <class T>
  [[nodiscard]] const T& output() const noexcept {
    static_assert(index_of<T>(typename Wires::OutputTokens{}) >= 0,
                  "Outputs does not list this token");
    return token<T>();
  }
  template <class T>
  [[nodiscard]] const T& token() const noexcept {
    static_assert(index_of<T>(typename Wires::Tokens{}) >= 0, "this graph has no such token");
    return tokens_.template slot<T>().now();
  }
  // Part `index` of a token written by a split.
  template <class T>
  [[nodiscard]] const T& parts(int index) const noexcept {
    return token<detail::PartsIn<T, typename Wires::Tokens>>()[index];
  }

  // Calls prepare() of every node that has one, in execution order, up to the first failure.
  [[nodiscard]] Prepared prepare() {
    Prepared result;
    in_order([&]<int unit>() { prepare_unit<unit>(result); });
    return result;
  }

  // Moves every Latest<> input to its newest version, once for all nodes of an activation.
  void sample() noexcept { sample_each(typename Wires::InputTokens{}); }

  // Runs every node once: in this thread, with a trace, or by an executor.
  void activate() noexcept {
    NoTrace trace;
    activate(trace);
  }
  template <Trace T>
  void activate(T& trace) noexcept {
    begin_activation();
    in_order([&]<int unit>() {
      for_each_index<Wires::copies[unit]>([&]<int copy>() { call<unit, copy>(trace); });
    });
  }
  template <class Executor>
  requires(!Trace<Executor>) void activate(Executor& executor) noexcept { executor.execute(*this); }

  // Runs the nodes in order until the boundary ends the activation. Returns the number of the last
  // node that ran. If nodes were skipped, the feedback stays as before the activation.
  template <Trace T, Boundary B>
  int activate_until(T& trace, B& boundary) noexcept {
    begin_activation();
    for (int number = 0; number + 1 < node_count; ++number) {
      call_number(number, trace);
      if (boundary.go_on(number)) continue;
      abandon_activation();
      return number;
    }
    call_number(node_count - 1, trace);
    (void)boundary.go_on(node_count - 1);
    return node_count - 1;
  }

  // For executors: makes the current tokens the previous ones. Once per activation, before all
  // nodes.
  void begin_activation() noexcept { tokens_.begin_activation(); }
  // For executors: undoes begin_activation() if nodes were skipped, so that the next activation
  // reads the same feedback.
  void abandon_activation() noexcept { tokens_.abandon_activation(); }
  // For executors: runs a node by its number in execution order; its writers must have run.
  template <Trace T>
  void call_number(int number, T& trace) noexcept {
    (this->*calls_by_number<T>[static_cast<std::size_t>(number)])(trace);
  }
  // For executors: runs one copy of one listed node; its writers must have run.
  template <int unit, int copy, class Trace>
  void call(Trace& trace) noexcept {
    constexpr int number = Wires::first_node[unit] + copy;
    using Listed = At<unit, typename Wires::Listed>;
    auto& node = static_cast<detail::NodeSlot<Listed>&>(nodes_).copies[copy].node;
    trace.on_node_begin(number);
    const auto run = [&]<class... P>(TypeList<P...>) { node(argument<Listed, P, copy>()...); };
    run(Parameters<Listed>{});
    trace.on_node_end(number);
  }

 private:
  template <class T>
  using Call = void (Graph::*)(T&) noexcept;
  template <class T>
  static constexpr auto calls_by_number = [] {
    std::array<Call<T>, static_cast<std::size_t>(node_count)> calls{};
    for_each_index<unit_count>([&]<int unit>() {
      for_each_index<Wires::copies[unit]>([&]<int copy>() {
        calls[static_cast<std::size_t>(Wires::first_node[unit] + copy)] =
            &Graph::template call<unit, copy, T>;
      });
    });
    return calls;
  }();

  template <class Node>
  [[nodiscard]] auto& slot_of() noexcept {
    return static_cast<detail::NodeSlot<typename detail::EntryOf<Node, Nodes...>::Type>&>(nodes_);
  }

  // Calls f<unit>() for every listed node in execution order.
  template <class F>
  static void in_order(F&& f) {
    for_each_index<unit_count>(
        [&]<int step>() { f.template operator()<Wires::order.units[step]>(); });
  }

  template <int unit>
  void prepare_unit(Prepared& result) {
    using Listed = At<unit, typename Wires::Listed>;
    using Node = typename Unit<Listed>::Node;
    if constexpr (requires(Node & node) { node.prepare(); }) {
      int number = Wires::first_node[unit];
      for (auto& cell : static_cast<detail::NodeSlot<Listed>&>(nodes_).copies) {
        if (!result) return;
        const auto reason = cell.node.prepare();
        static_assert(std::is_enum_v<std::remove_cv_t<decltype(reason)>>,
                      "prepare() returns an enumeration whose 0 means ready");
        if (static_cast<int>(reason) != 0) {
          result = {number, type_name<Node>(), static_cast<int>(reason)};
        }
        ++number;
      }
    }
  }

  template <class... T>
  void sample_each(TypeList<T...> /*inputs*/) noexcept {
    (sample_one(tokens_.template slot<T>().now()), ...);
  }
  template <class T>
  static void sample_one(Latest<T>& latest) noexcept {
    latest.sample();
  }
  template <class T>
  static void sample_one(T& /*plain input*/) noexcept {}

  template <class Listed, class Parameter, int copy>
  [[nodiscard]] decltype(auto) argument() noexcept {
    using Token = TokenOf<Listed, Parameter>;
    constexpr PortKind kind = Port<Parameter>::kind;
    if constexpr (kind == PortKind::partition) {
      return Partition{copy, Unit<Listed>::count};
    } else if constexpr (kind == PortKind::previous) {
      return Previous<Token>(std::as_const(tokens_.template slot<Token>().before()));
    } else if constexpr (kind == PortKind::write && Unit<Listed>::split) {
      return (tokens_.template slot<Token>().now()[copy]);
    } else {
      return (tokens_.template slot<Token>().now());
    }
  }

  detail::TokenStore<Wires, typename Wires::Tokens> tokens_;
  detail::NodeStore<Nodes...> nodes_;
};

namespace detail {
template <class G>
inline constexpr bool valid_graph = false;
template <class In, class Out, class... Nodes>
inline constexpr bool valid_graph<Graph<In, Out, Nodes...>> =
    check_graph<Wiring<In, Out, Nodes...>, Nodes...>();
}  // namespace detail

// True for a graph that satisfies all rules; otherwise a compile error that names the token.
template <class G>
inline constexpr bool valid = detail::valid_graph<G>;

}  // namespace glint::graph
