#include "platform/rt/worker_pool.hpp"

#include <gtest/gtest.h>

#include "tests/unit/graph/small_graph.hpp"

namespace glint::test {
namespace {

std::unique_ptr<SmallGraph> ready_graph() {
  auto graph = std::make_unique<SmallGraph>();
  graph->latest<Scale>().set({3}, 1, 0);
  return graph;
}

template <class How>
int total_after(int activations, How& how) {
  const auto graph = ready_graph();
  for (int i = 0; i < activations; ++i) {
    graph->input<Row>().numbers = {i, 1, 2, i, 4, 5, i, 7};
    graph->activate(how);
  }
  return graph->output<Total>().value;
}

TEST(ParallelExecutor, GivesTheSameResultAsOneThread) {
  Serial serial;
  ParallelExecutor<1> alone({}, 1000);
  ParallelExecutor<2> two({{"worker"}}, 1000);
  ParallelExecutor<3> three({{"worker 1"}, {"worker 2"}}, 1000);
  const int total = total_after(300, serial);
  EXPECT_EQ(total_after(300, alone), total);
  EXPECT_EQ(total_after(300, two), total);
  EXPECT_EQ(total_after(300, three), total);
}

TEST(ParallelExecutor, RunsEachCopyOnceByTheWorkerOfItsNumber) {
  ParallelExecutor<2> two({{"worker"}}, 1000);
  const auto graph = ready_graph();
  for (int i = 0; i < 100; ++i) graph->activate(two);
  EXPECT_EQ(graph->node<SumBand>(0).calls, 100);
  EXPECT_EQ(graph->node<SumBand>(1).calls, 100);
}

TEST(ParallelExecutor, RefusesSettingsForAnotherNumberOfWorkers) {
  EXPECT_THROW((ParallelExecutor<2>({}, 1000)), std::logic_error);
}

TEST(ParallelExecutor, ReportsWhatItsThreadsWereGranted) {
  ParallelExecutor<2> two({{"worker", 100'000}}, 1000);
  ASSERT_EQ(two.reports().size(), 1u);
  EXPECT_EQ(two.reports()[0].name, "worker");
  EXPECT_FALSE(two.reports()[0].pinned);
}

struct Doubled {
  int value = 0;
};
struct Twice {
  void operator()(const Total& in, Doubled& out) const noexcept { out.value = 2 * in.value; }
};

TEST(ParallelExecutor, LeavesItsThreadsAsleepForAGraphWithoutASplit) {
  ParallelExecutor<2> two({{"worker"}}, 1000);
  for (int i = 0; i < 100; ++i) {  // each graph is gone before a late worker could look at it
    graph::Graph<Inputs<Total>, Outputs<Doubled>, Twice> graph;
    graph.input<Total>().value = i;
    graph.activate(two);
    EXPECT_EQ(graph.output<Doubled>().value, 2 * i);
  }
}

}  // namespace
}  // namespace glint::test
