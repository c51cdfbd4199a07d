// Rate group: a graph with its own rate. Each release samples the inputs from other groups once and
// records their versions; a replay needs only these records.
#pragma once

#include <array>
#include <cstdint>

#include "graph/latest.hpp"
#include "graph/type_list.hpp"

namespace glint::graph {

inline constexpr int k_latest_max = 8;  // Latest<> inputs of one graph

// Inputs of a group at one release. The versions are in the order of Inputs<>.
struct ReleaseInputs {
  std::uint32_t group = 0;
  std::uint64_t activation = 0;  // counts from 1
  std::int64_t nominal_ns = 0;   // the planned release time, not the actual one
  int version_count = 0;
  std::array<std::uint64_t, k_latest_max> versions{};
  bool operator==(const ReleaseInputs&) const = default;
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

  // Live: samples the newest version of every Latest<> input. activate() runs the nodes.
  const ReleaseInputs& release(std::int64_t nominal_ns) noexcept {
    graph_->sample();
    begin(choice_.activation + 1, nominal_ns);
    return choice_;
  }

  // Replay: samples only inputs that do not have the recorded version yet. Returns false if a
  // version then differs: the replay has not published that version, or has published a newer one.
  [[nodiscard]] bool release_as(const ReleaseInputs& recorded) noexcept {
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

  [[nodiscard]] const ReleaseInputs& choice() const noexcept { return choice_; }
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
  ReleaseInputs choice_;
};

}  // namespace glint::graph
