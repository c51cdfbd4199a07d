// Benchmark of the cost of a call through the graph: four trivial nodes, listed in the wrong order,
// compared with the same four called by hand and with oneTBB's flow graph. Exit 1: a limit is
// missed.
//
//   build/bench_dispatch [ROUNDS]
#include <array>
#include <cstdio>
#include <memory>

#include "dispatch_nodes.hpp"
#include "dispatch_rows.hpp"
#include "dispatch_tbb.hpp"
#include "dispatch_trace.hpp"
#include "rounds.hpp"

namespace glint::bench {
namespace {

constexpr int k_rounds = 20'000;
// Long enough to make the two readings of the clock negligible: 16 us of the fastest row.
constexpr int k_untimed_activations = 4096;
constexpr int k_traced_activations = 64;
constexpr int k_tbb_activations = 16;

constexpr double k_untimed_max_ns = 2;
constexpr double k_traced_max_ns = 60;
constexpr double k_tbb_ratio_min = 30;

// Makes the compiler assume that the object is read and written between two activations.
template <class T>
void seen(T& object) {
  asm volatile("" : : "r"(&object) : "memory");
}

template <class Chain>
DispatchRow chain_row(const char* name) {
  return {name, k_untimed_activations * k_dispatch_nodes, [chain = std::make_shared<Chain>()] {
            for (int i = 0; i < k_untimed_activations; ++i) {
              ++chain->a.value;
              chain->activate();
              seen(*chain);
            }
          }};
}

template <class G, class Trace>
DispatchRow graph_row(const char* name, int activations, std::shared_ptr<Trace> trace) {
  return {name, activations * k_dispatch_nodes,
          [graph = std::make_shared<G>(), trace, activations] {
            for (int i = 0; i < activations; ++i) {
              ++graph->template input<A>().value;
              graph->activate(*trace);
              seen(*graph);
            }
          }};
}

DispatchRow tbb_row(const char* name, TbbPolicy policy) {
  return {name, k_tbb_activations * k_dispatch_nodes, [flow = std::make_shared<TbbFlow>(policy)] {
            const int result = flow->run(k_tbb_activations);
            seen(result);
          }};
}

bool run(int rounds) {
  const auto untimed = std::make_shared<graph::NoTrace>();
  std::vector<DispatchRow> rows;
  rows.push_back(chain_row<InlinedChain>("chain by hand, inlined"));
  rows.push_back(graph_row<InlinedGraph>("graph, inlined", k_untimed_activations, untimed));
  rows.push_back(chain_row<CalledChain>("chain by hand, called"));
  rows.push_back(graph_row<CalledGraph>("graph, called", k_untimed_activations, untimed));
  rows.push_back(graph_row<CalledGraph>("graph, called, timed", k_traced_activations,
                                        std::make_shared<TimeOnly>()));
  rows.push_back(graph_row<CalledGraph>("graph, called, timed and traced", k_traced_activations,
                                        std::make_shared<TimeAndTrace>()));
  rows.push_back(tbb_row("oneTBB flow graph", TbbPolicy::spawned));
  rows.push_back(tbb_row("oneTBB flow graph, lightweight policy", TbbPolicy::lightweight));
  measure_in_turn(rows, rounds);

  print_machine();
  print_rows(rows);
  const double called = rows[3].p50(), traced = rows[5].p50(), tbb = rows[6].p50();
  bool met = print_bar("untimed node, called", called, "ns", k_untimed_max_ns, true);
  met &= print_bar("timed and traced node, called", traced, "ns", k_traced_max_ns, true);
  met &= print_bar("oneTBB / untimed node", tbb / called, "x", k_tbb_ratio_min, false);
  return met;
}

}  // namespace
}  // namespace glint::bench

int main(int argc, char** argv) {
  const auto rounds = glint::bench::rounds_of(argc, argv, glint::bench::k_rounds, 1000);
  if (!rounds) return 2;
  return glint::bench::run(*rounds) ? 0 : 1;
}
