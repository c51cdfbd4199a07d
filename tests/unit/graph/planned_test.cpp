#include "graph/planned.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <memory>
#include <random>
#include <thread>
#include <vector>

#include "wide_graph.hpp"
#include "yielding_rest.hpp"

namespace glint::test::planned_test {
namespace {

using Tables = ScheduleTables<WideGraph>;

// Random order within the data dependencies. Node 0 runs on worker 0, the others on any worker.
Tables random_plan(int workers, std::mt19937& random) {
  Tables tables;
  tables.workers = workers;
  NodeSet run = 0;
  while (std::popcount(run) < WideGraph::node_count) {
    std::vector<int> ready;
    for (int node = 0; node < WideGraph::node_count; ++node) {
      const NodeSet needed = predecessors<WideGraph>[static_cast<std::size_t>(node)];
      if ((run >> node & 1u) == 0 && (needed & ~run) == 0) ready.push_back(node);
    }
    const int node = ready[random() % ready.size()];
    EXPECT_TRUE(tables.add(node, run == 0 ? 0 : static_cast<int>(random()) & (workers - 1)));
    run |= NodeSet{1} << node;
  }
  return tables;
}

template <class B>
int run_once(WideGraph& graph, Planned<WideGraph, YieldingRest>& planned, B& boundary) {
  NoTrace trace;
  planned.begin(graph);
  std::vector<std::thread> others;
  for (int w = 1; w < planned.workers(); ++w) {
    others.emplace_back([&, w] { planned.run_worker(graph, w, trace); });
  }
  const int last = planned.run_leader(graph, trace, boundary);
  planned.finish_activation(graph);
  for (std::thread& other : others) other.join();
  return last;
}

std::vector<double> serial_sums(int activations) {
  auto graph = std::make_unique<WideGraph>();
  std::vector<double> sums;
  for (int i = 0; i < activations; ++i) {
    graph->activate();
    sums.push_back(graph->output<Result>().sum);
  }
  return sums;
}

TEST(Planned, GivesTheSameBytesAsTheSerialExecutorByAnyValidPlan) {
  const std::vector<double> sums = serial_sums(10);
  EXPECT_NE(sums[9], sums[8]);
  std::mt19937 random(7);
  for (const int workers : {1, 2, 4}) {
    for (int plan = 0; plan < 20; ++plan) {
      const Tables tables = random_plan(workers, random);
      ASSERT_FALSE(schedule_fault(tables).found());
      auto graph = std::make_unique<WideGraph>();
      YieldingRest rest;
      Planned<WideGraph, YieldingRest> planned(tables, rest);
      NoBoundary always;
      for (const double sum : sums) {
        EXPECT_EQ(run_once(*graph, planned, always), WideGraph::node_count - 1);
        EXPECT_EQ(graph->output<Result>().sum, sum);
      }
    }
  }
}

TEST(Planned, FollowsTheRuleOfTheReferenceExecutorWithoutAPlan) {
  constexpr Tables tables = default_schedule<WideGraph>(2);
  static_assert(!schedule_fault(tables).found());
  const std::array<std::uint8_t, 10> expected = {0, 0, 1, 0, 1, 0, 0, 1, 0, 0};
  EXPECT_EQ(tables.worker, expected);
}

TEST(Planned, RefusesAnOrderThatIsNoPermutation) {
  Tables tables = default_schedule<WideGraph>(2);
  tables.order[0][2] = tables.order[0][1];
  EXPECT_EQ(schedule_fault(tables).error, PlanError::ran_twice);
  tables = default_schedule<WideGraph>(2);
  --tables.count[1];
  EXPECT_EQ(schedule_fault(tables).error, PlanError::left_out);
  EXPECT_EQ(schedule_fault(tables).node, 7);
  tables = default_schedule<WideGraph>(2);
  tables.order[1][0] = 77;
  EXPECT_EQ(schedule_fault(tables).error, PlanError::unknown_node);
  tables.workers = 5;
  EXPECT_EQ(schedule_fault(tables).error, PlanError::workers);
}

TEST(Planned, RefusesAnOrderInWhichANodeWaitsForEver) {
  Tables tables = default_schedule<WideGraph>(1);
  std::swap(tables.order[0][9], tables.order[0][8]);  // Merge before a sum that it reads
  EXPECT_EQ(schedule_fault(tables).error, PlanError::waits);
  EXPECT_EQ(schedule_fault(tables).node, 9);
  std::swap(tables.order[0][9], tables.order[0][8]);
  std::swap(tables.order[0][0], tables.order[0][1]);
  EXPECT_EQ(schedule_fault(tables).error, PlanError::first_node);
}

struct StopAfter {
  int node;
  bool go_on(int at) const noexcept { return at != node; }
};

TEST(Planned, LeavesNoTraceOfAnAbandonedActivationInWhatIsFedBack) {
  // Make counts its calls: the sums differ if it does not run. An unfinished activation must not
  // advance Previous<Result>.
  for (const int workers : {1, 2, 4}) {
    auto expected = std::make_unique<WideGraph>();
    auto graph = std::make_unique<WideGraph>();
    YieldingRest rest;
    Planned<WideGraph, YieldingRest> planned(default_schedule<WideGraph>(workers), rest);
    NoTrace trace;
    for (int i = 0; i < 12; ++i) {
      NoBoundary always;
      StopAfter stop{0};
      if (i % 3 == 1) {
        EXPECT_EQ(run_once(*graph, planned, stop), 0);
        EXPECT_EQ(expected->activate_until(trace, stop), 0);
      } else {
        (void)run_once(*graph, planned, always);
        EXPECT_EQ(expected->activate_until(trace, always), WideGraph::node_count - 1);
      }
      EXPECT_EQ(graph->output<Result>().sum, expected->output<Result>().sum);
    }
  }
}

TEST(Planned, KeepsTheFeedbackOfAnActivationThatWasLateOnlyAfterItsLastNode) {
  auto graph = std::make_unique<WideGraph>();
  YieldingRest rest;
  Planned<WideGraph, YieldingRest> planned(default_schedule<WideGraph>(1), rest);
  for (const double sum : serial_sums(4)) {
    StopAfter stop{WideGraph::node_count - 1};
    EXPECT_EQ(run_once(*graph, planned, stop), WideGraph::node_count - 1);
    EXPECT_EQ(graph->output<Result>().sum, sum);
  }
}

// Boundary that returns true `checks_left` times, then false: the deadline while worker 0 waits.
struct CountedBoundary {
  std::uint64_t checks_left;
  bool go_on(int) noexcept { return checks_left > 0 && checks_left-- > 0; }
};

TEST(Planned, EndsAtItsDeadlineWhileAnotherWorkerIsLateAndWaitsForItOnlyAfterwards) {
  auto graph = std::make_unique<WideGraph>();
  YieldingRest rest{10};
  Planned<WideGraph, YieldingRest> planned(default_schedule<WideGraph>(2), rest);
  NoTrace trace;
  CountedBoundary boundary{k_sleeps_max + 10};
  planned.begin(*graph);
  const int last = planned.run_leader(*graph, trace, boundary);  // worker 1 was never released
  EXPECT_EQ(last, 1) << "Make and the first Spread ran, the second is worker 1's";
  EXPECT_EQ(planned.overruns(), 1u);
  std::thread late([&] { planned.run_worker(*graph, 1, trace); });
  planned.finish_activation(*graph);
  late.join();
  EXPECT_EQ(graph->output<Result>().sum, Result{}.sum) << "nothing was fed back";
  NoBoundary always;
  EXPECT_EQ(run_once(*graph, planned, always), WideGraph::node_count - 1);
}

}  // namespace
}  // namespace glint::test::planned_test
