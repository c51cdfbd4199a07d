// What a call through the graph costs: four trivial nodes, listed in the wrong order, beside the
// same four called by hand and beside the same four behind virtual functions.
//
//   build/bench_dispatch --benchmark_repetitions=9 --benchmark_report_aggregates_only=true
#include <benchmark/benchmark.h>

#include <array>
#include <memory>

#include "graph/graph.hpp"

namespace {

using namespace glint::graph;

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
  void operator()(const D& d, const Previous<E>& last, E& e) const noexcept {
    e.value = last.value().value + d.value;
  }
};
using FourNodes = Graph<Inputs<A>, Outputs<E>, MakeE, MakeC, MakeD, MakeB>;
static_assert(valid<FourNodes>);

void graph_of_four_nodes(benchmark::State& state) {
  static FourNodes graph;
  for (auto _ : state) {
    ++graph.input<A>().value;
    graph.activate();
    benchmark::DoNotOptimize(graph);
    benchmark::ClobberMemory();
  }
}

void four_calls_by_hand(benchmark::State& state) {
  struct Tokens {
    A a;
    B b;
    C c;
    D d;
    std::array<E, 2> e;
    int now = 0;
  };
  static Tokens t;
  for (auto _ : state) {
    ++t.a.value;
    t.now ^= 1;
    MakeB{}(t.a, t.b);
    MakeC{}(t.b, t.c);
    MakeD{}(t.b, t.c, t.d);
    MakeE{}(t.d, Previous<E>(t.e[static_cast<std::size_t>(t.now ^ 1)]),
            t.e[static_cast<std::size_t>(t.now)]);
    benchmark::DoNotOptimize(t);
    benchmark::ClobberMemory();
  }
}

struct Tokens {
  A a;
  B b;
  C c;
  D d;
  E e;
};
struct Step {
  virtual ~Step() = default;
  virtual void run(Tokens& t) const = 0;
};
struct StepB : Step {
  void run(Tokens& t) const override { MakeB{}(t.a, t.b); }
};
struct StepC : Step {
  void run(Tokens& t) const override { MakeC{}(t.b, t.c); }
};
struct StepD : Step {
  void run(Tokens& t) const override { MakeD{}(t.b, t.c, t.d); }
};
struct StepE : Step {
  void run(Tokens& t) const override { MakeE{}(t.d, Previous<E>(t.e), t.e); }
};

void four_virtual_calls(benchmark::State& state) {
  std::array<std::unique_ptr<Step>, 4> steps = {
      std::make_unique<StepB>(), std::make_unique<StepC>(), std::make_unique<StepD>(),
      std::make_unique<StepE>()};
  benchmark::DoNotOptimize(steps);
  static Tokens t;
  for (auto _ : state) {
    ++t.a.value;
    for (const auto& step : steps) step->run(t);
    benchmark::DoNotOptimize(t);
    benchmark::ClobberMemory();
  }
}

BENCHMARK(graph_of_four_nodes);
BENCHMARK(four_calls_by_hand);
BENCHMARK(four_virtual_calls);

}  // namespace

BENCHMARK_MAIN();
