// A graph with a rate of its own: at each release it samples what comes from other groups, once,
// and notes which versions it got. These notes are all that a replay needs to decide alike.
#pragma once

#include <array>
#include <cstdint>

#include "graph/latest.hpp"
#include "graph/type_list.hpp"

namespace glint::graph {

inline constexpr int k_latest_max = 8;  // Latest<> inputs of one graph

// What a group was given at one release. The versions stand in the order of Inputs<>.
struct Choice {
  std::uint32_t group = 0;
  std::uint64_t activation = 0;  // counts from 1
  std::int64_t nominal_ns = 0;   // the release as planned, never as it came
  int version_count = 0;
  std::array<std::uint64_t, k_latest_max> versions{};
  bool operator==(const Choice&) const = default;
};

namespace detail {
template <class Token>
inline constexpr int is_latest = 0;
template <class T>
inline constexpr int is_latest<Latest<T>> = 1;
}  // namespace detail

template <class G>
class RateGroup {
 public:
  RateGroup(G& graph, std::uint32_t group) noexcept : graph_(&graph) { choice_.group = group; }

  // Live: takes the newest version of every Latest<> input. The nodes run in activate().
  const Choice& release(std::int64_t nominal_ns) noexcept {
    graph_->sample();
    begin(choice_.activation + 1, nominal_ns);
    return choice_;
  }

  // Replay: leaves alone what already has the recorded version and samples the rest. False if then
  // a version differs: the replay has not published what was read, or has published too much.
  [[nodiscard]] bool release_as(const Choice& recorded) noexcept {
    int i = 0;
    each_latest([&](auto& latest) {
      if (i < recorded.version_count && latest.version() != recorded.versions[i]) latest.sample();
      ++i;
    });
    begin(recorded.activation, recorded.nominal_ns);
    return choice_ == recorded;
  }

  // Runs the nodes; arguments as for Graph::activate (none, a trace, or an executor).
  template <class... How>
  void activate(How&... how) noexcept {
    graph_->activate(how...);
  }

  [[nodiscard]] const Choice& choice() const noexcept { return choice_; }
  [[nodiscard]] G& graph() noexcept { return *graph_; }

 private:
  using InputTokens = typename G::Wires::InputTokens;

  void begin(std::uint64_t activation, std::int64_t nominal_ns) noexcept {
    choice_.activation = activation;
    choice_.nominal_ns = nominal_ns;
    choice_.version_count = 0;
    each_latest(
        [&](auto& latest) { choice_.versions[choice_.version_count++] = latest.version(); });
  }

  // Calls f(Latest<T>&) for every such input, in the order of Inputs<>.
  template <class F>
  void each_latest(F f) noexcept {
    each_latest(f, InputTokens{});
  }
  template <class F, class... Token>
  void each_latest(F& f, TypeList<Token...> /*inputs*/) noexcept {
    static_assert((detail::is_latest<Token> + ... + 0) <= k_latest_max, "too many Latest<> inputs");
    (visit(f, static_cast<Token*>(nullptr)), ...);
  }
  template <class F, class T>
  void visit(F& f, Latest<T>* /*kind*/) noexcept {
    f(graph_->template latest<T>());
  }
  template <class F, class T>
  void visit(F& /*f*/, T* /*kind*/) noexcept {}

  G* graph_;
  Choice choice_;
};

}  // namespace glint::graph
