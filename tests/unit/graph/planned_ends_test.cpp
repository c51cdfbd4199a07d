// Early end of an activation in the planned executor: last node, reports, nodes that do not run.
#include <gtest/gtest.h>

#include <atomic>
#include <memory>
#include <thread>
#include <vector>

#include "graph/planned.hpp"
#include "small_graph.hpp"
#include "wide_graph.hpp"
#include "yielding_rest.hpp"

namespace glint::test::planned_ends_test {
namespace {

struct CountingRest : YieldingRest {
  std::atomic<std::uint32_t> slept{0}, reported{0};
  [[nodiscard]] bool sleep(std::uint32_t /*seen*/) noexcept {
    ++slept;
    std::this_thread::yield();
    return false;
  }
  void report_progress() noexcept { ++reported; }
};

struct Ran {
  std::vector<int>* nodes;
  void on_node_begin(int node) { nodes->push_back(node); }
  void on_node_end(int /*node*/) {}
};

struct StopAfter {
  int node;
  bool go_on(int at) const noexcept { return at != node; }
};

TEST(PlannedEnds, AfterAnyNodeAsTheSerialExecutorDoes) {
  for (int node = 0; node < WideGraph::node_count; ++node) {
    auto graph = std::make_unique<WideGraph>(), expected = std::make_unique<WideGraph>();
    YieldingRest rest;
    Planned<WideGraph, YieldingRest> planned(default_schedule<WideGraph>(1), rest);
    for (const bool whole : {true, false, true}) {
      StopAfter stop{whole ? -1 : node};
      std::vector<int> ran, expected_to_run;
      Ran trace{&ran}, expected_trace{&expected_to_run};
      planned.begin(*graph);
      const int last = planned.run_leader(*graph, trace, stop);
      planned.finish_activation(*graph);
      EXPECT_EQ(last, expected->activate_until(expected_trace, stop)) << node;
      EXPECT_EQ(ran, expected_to_run) << node;
      EXPECT_EQ(graph->output<Result>().sum, expected->output<Result>().sum) << node;
    }
    EXPECT_EQ(planned.overruns(), 0U);
  }
}

// Worker 0 ends the activation before worker 1 is released.
TEST(PlannedEnds, RunNoNodeOnAnotherWorkerAfterwards) {
  auto graph = std::make_unique<WideGraph>();
  CountingRest rest;
  Planned<WideGraph, CountingRest> planned(default_schedule<WideGraph>(2), rest);
  EXPECT_EQ(planned.workers(), 2);
  for (int activation = 0; activation < 3; ++activation) {
    NoTrace none;
    StopAfter stop{0};
    planned.begin(*graph);
    EXPECT_EQ(planned.run_leader(*graph, none, stop), 0);
    const std::uint32_t before = rest.reported;
    std::vector<int> ran;
    Ran trace{&ran};
    planned.run_worker(*graph, 1, trace);
    EXPECT_TRUE(ran.empty());
    EXPECT_EQ(rest.reported.load(), before + 1) << "worker 0 may wait for it to end";
    planned.finish_activation(*graph);
    EXPECT_EQ(graph->output<Result>().sum, Result{}.sum);
  }
  EXPECT_EQ(planned.overruns(), 0U);
}

// Reported: each node that another worker reads, and the end of each worker except the first.
TEST(PlannedEnds, ReportWhatAnotherWorkerWaitsForAndNoMore) {
  for (const int workers : {1, 2}) {
    auto graph = std::make_unique<WideGraph>();
    CountingRest rest;
    Planned<WideGraph, CountingRest> planned(default_schedule<WideGraph>(workers), rest);
    NoTrace trace;
    NoBoundary always;
    planned.begin(*graph);
    std::vector<std::thread> others;
    for (int w = 1; w < workers; ++w) {
      others.emplace_back([&, w] { planned.run_worker(*graph, w, trace); });
    }
    EXPECT_EQ(planned.run_leader(*graph, trace, always), WideGraph::node_count - 1);
    planned.finish_activation(*graph);
    for (std::thread& other : others) other.join();
    // Make, the Spreads, the sum of worker 1, and the end of worker 1.
    EXPECT_EQ(rest.reported.load(), workers == 1 ? 0U : 1U + 5U + 1U + 1U);
  }
}

TEST(PlannedEnds, CountTheOverrunsOfEveryWorker) {
  auto graph = std::make_unique<WideGraph>();
  CountingRest rest;
  rest.spins = 3;
  Planned<WideGraph, CountingRest> planned(default_schedule<WideGraph>(2), rest);
  NoTrace trace;
  NoBoundary always;
  planned.begin(*graph);
  std::thread other([&] { planned.run_worker(*graph, 1, trace); });
  while (rest.slept < k_sleeps_max) std::this_thread::yield();
  EXPECT_EQ(planned.run_leader(*graph, trace, always), WideGraph::node_count - 1);
  planned.finish_activation(*graph);
  other.join();
  EXPECT_GE(planned.overruns(), 1U);
}

// One source, two readers. The second reader runs on the other worker; no node reads its output.
struct Source {
  void operator()(Row& row) const noexcept { row.numbers.fill(1); }
};
struct Left {
  void operator()(const Row&, const Previous<Total>& last, Total& total) const noexcept {
    total.value = last.value().value + 1;
  }
};
struct Right {
  void operator()(const Row&, Sum& sum) const noexcept { sum.value = 1; }
};
using Fork = Graph<Inputs<>, Outputs<Total, Sum>, Source, Left, Right>;

ScheduleTables<Fork> fork_plan() {
  ScheduleTables<Fork> tables;
  tables.workers = 2;
  tables.add(0, 0);
  tables.add(1, 0);
  tables.add(2, 1);
  EXPECT_FALSE(schedule_fault(tables).found());
  return tables;
}

TEST(PlannedEnds, BeforeTheEndWhereTheOtherWorkersNodeIsMissing) {
  static Fork graph;
  YieldingRest rest;
  Planned<Fork, YieldingRest> planned(fork_plan(), rest);
  NoTrace trace;
  StopAfter stop{1};
  planned.begin(graph);
  EXPECT_EQ(planned.run_leader(graph, trace, stop), 1);
  planned.run_worker(graph, 1, trace);
  planned.finish_activation(graph);
  EXPECT_EQ(graph.output<Total>().value, 0) << "nothing was fed back";
}

// Returns false after worker 0's last node, once the other worker has ended.
struct LateFalseBoundary {
  std::thread* other;
  bool go_on(int at) {
    if (at == 0) return true;
    if (other->joinable()) other->join();
    return false;
  }
};

TEST(PlannedEnds, WithTheLastNodeWhereAllHaveRunBeforeTheBoundarySaidNo) {
  static Fork graph;
  YieldingRest rest;
  Planned<Fork, YieldingRest> planned(fork_plan(), rest);
  NoTrace trace;
  for (int activation = 1; activation <= 3; ++activation) {
    planned.begin(graph);
    std::thread other([&] { planned.run_worker(graph, 1, trace); });
    LateFalseBoundary late{&other};
    EXPECT_EQ(planned.run_leader(graph, trace, late), 2);
    planned.finish_activation(graph);
    if (other.joinable()) other.join();
    EXPECT_EQ(graph.output<Total>().value, activation) << "the feedback stays";
    EXPECT_EQ(graph.output<Sum>().value, 1);
  }
}

}  // namespace
}  // namespace glint::test::planned_ends_test
