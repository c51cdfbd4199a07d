// Measures the static bytes and the deepest stack of each node in ten thousand cycles, as JSON on
// standard output. tests/footprint/figures joins them with the compiler's figures.
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <vector>

#include "platform/budget/footprint.hpp"
#include "tests/footprint/groups.hpp"
#include "tests/footprint/node_calls.hpp"
#include "tests/footprint/painted_stack.hpp"

namespace glint::footprint {
namespace {

// Each node of one graph on a stack of its own.
template <class G>
class PaintedNodes {
 public:
  PaintedNodes(const char* group, std::span<const NodeCall<G>> calls)
      : group_(group), calls_(calls), stacks_(calls.size()) {}

  void run(G& graph) noexcept {
    graph.begin_activation();
    for (std::size_t i = 0; i < calls_.size(); ++i) {
      Job job{calls_[i].call, &graph};
      stacks_[i].run(
          [](void* raw) noexcept {
            const Job& one = *static_cast<Job*>(raw);
            one.call(*one.graph);
          },
          &job);
    }
  }

  void add_to(nlohmann::json& rows) const {
    for (std::size_t i = 0; i < calls_.size(); ++i) {
      const NodeFootprint& node = Footprint<G>::nodes[i];
      rows.push_back({{"group", group_},
                      {"name", node.name},
                      {"copies", node.copies},
                      {"state_bytes", node.state_bytes},
                      {"token_bytes", node.token_bytes},
                      {"stack_observed_bytes", stacks_[i].used_bytes()}});
    }
  }

 private:
  struct Job {
    void (*call)(G&) noexcept;
    G* graph;
  };
  const char* group_;
  std::span<const NodeCall<G>> calls_;
  std::vector<PaintedStack> stacks_;
};

// The activation of one whole graph on one stack.
template <class G>
class PaintedGraph {
 public:
  explicit PaintedGraph(void (*activate)(G&) noexcept) : activate_(activate) {}
  void run(G& graph) noexcept {
    graph_ = &graph;
    stack_.run(
        [](void* raw) noexcept {
          const PaintedGraph& self = *static_cast<PaintedGraph*>(raw);
          self.activate_(*self.graph_);
        },
        this);
  }
  [[nodiscard]] std::size_t used_bytes() const noexcept { return stack_.used_bytes(); }

 private:
  void (*activate_)(G&) noexcept;
  G* graph_ = nullptr;
  PaintedStack stack_;
};

int run() {
  nlohmann::json nodes = nlohmann::json::array();
  {
    PaintedNodes<Tracker> frame("frame", tracker_calls());
    PaintedNodes<Output> tick("tick", output_calls());
    Groups<> groups;
    for (std::uint32_t i = 0; i < k_cycles; ++i) {
      groups.cycle(i, [&]<class G>(G& graph) {
        if constexpr (std::is_same_v<G, Tracker>) {
          frame.run(graph);
        } else {
          tick.run(graph);
        }
      });
    }
    frame.add_to(nodes);
    tick.add_to(nodes);
  }
  PaintedGraph<Tracker> frame(&activate_tracker);
  PaintedGraph<Output> tick(&activate_output);
  Groups<> groups;
  for (std::uint32_t i = 0; i < k_cycles; ++i) {
    groups.cycle(i, [&]<class G>(G& graph) {
      if constexpr (std::is_same_v<G, Tracker>) {
        frame.run(graph);
      } else {
        tick.run(graph);
      }
    });
  }
  const nlohmann::json figures = {{"nodes", nodes},
                                  {"cycles", k_cycles},
                                  {"total_bytes", sizeof(Tracker) + sizeof(Output)},
                                  {"groups",
                                   {{{"name", "frame"},
                                     {"bytes", sizeof(Tracker)},
                                     {"inputs_bytes", Footprint<Tracker>::inputs_bytes},
                                     {"stack_observed_bytes", frame.used_bytes()}},
                                    {{"name", "tick"},
                                     {"bytes", sizeof(Output)},
                                     {"inputs_bytes", Footprint<Output>::inputs_bytes},
                                     {"stack_observed_bytes", tick.used_bytes()}}}}};
  std::puts(figures.dump(1).c_str());
  return 0;
}

}  // namespace
}  // namespace glint::footprint

int main() { return glint::footprint::run(); }
