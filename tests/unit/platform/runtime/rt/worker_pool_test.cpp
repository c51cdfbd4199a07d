#include "platform/runtime/rt/worker_pool.hpp"

#include <gtest/gtest.h>
#include <sys/types.h>
#include <unistd.h>

#include <array>
#include <fstream>
#include <iterator>
#include <memory>
#include <span>
#include <string>

#include "platform/runtime/rt/clock.hpp"
#include "platform/runtime/rt/planned_executor.hpp"
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
  for (int i = 0; i < 100; ++i) {  // each graph is destroyed before a late worker could access it
    graph::Graph<Inputs<Total>, Outputs<Doubled>, Twice> graph;
    graph.input<Total>().value = i;
    graph.activate(two);
    EXPECT_EQ(graph.output<Doubled>().value, 2 * i);
  }
}

struct Caller {
  pid_t thread = 0;
};
struct Slept {
  bool value = false;
};
// Part 1 ends when the thread of part 0 sleeps, or after a time limit.
struct AwaitSleep {
  void operator()(const Caller& caller, Partition partition, Slept& slept) const noexcept {
    const std::string path = "/proc/self/task/" + std::to_string(caller.thread) + "/stat";
    const Time limit = monotonic_now() + milliseconds(20'000);
    while (partition.index == 1 && !slept.value && monotonic_now() < limit) {
      std::ifstream stat(path);
      const std::string text{std::istreambuf_iterator<char>(stat), {}};
      slept.value = text.find(") S ") != std::string::npos;
    }
  }
};
struct Answer {
  bool slept = false;
};
struct Collect {
  void operator()(const Parts<Slept, 2>& parts, Answer& answer) const noexcept {
    answer.slept = parts[1].value;
  }
};
using AwaitGraph = graph::Graph<Inputs<Caller>, Outputs<Answer>, Split<AwaitSleep, 2>, Collect>;

TEST(ParallelExecutor, SleepsWhileItWaitsForAnotherWorker) {
  ParallelExecutor<2> two({{"worker"}}, 1000);
  AwaitGraph graph;
  graph.input<Caller>().thread = gettid();
  graph.activate(two);
  EXPECT_TRUE(graph.output<Answer>().slept) << "it kept its core for 20 s";
}

TEST(PlannedExecutor, SleepsWhileItWaitsForAnotherWorker) {
  PlannedExecutor<AwaitGraph> two(default_schedule<AwaitGraph>(2), {{"worker"}}, 1000);
  AwaitGraph graph;
  graph.input<Caller>().thread = gettid();
  std::array<NoTrace, k_plan_workers_max> none;
  NoBoundary always;
  (void)two.execute(graph, std::span<NoTrace>(none), always);
  two.finish_activation(graph);
  EXPECT_TRUE(graph.output<Answer>().slept) << "it kept its core for 20 s";
}

}  // namespace
}  // namespace glint::test
