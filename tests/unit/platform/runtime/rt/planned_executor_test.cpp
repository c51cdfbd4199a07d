#include "platform/runtime/rt/planned_executor.hpp"

#include <gtest/gtest.h>

#include <array>
#include <memory>

#include "tests/unit/graph/wide_graph.hpp"

namespace glint::test {
namespace {

std::array<NoTrace, k_plan_workers_max> g_none;

TEST(PlannedExecutor, GivesTheSameBytesAsOneThread) {
  const auto expected = std::make_unique<WideGraph>();
  const auto graph = std::make_unique<WideGraph>();
  PlannedExecutor<WideGraph> two(default_schedule<WideGraph>(2), {{"worker"}}, 100'000);
  NoBoundary always;
  for (int i = 0; i < 300; ++i) {
    expected->activate();
    EXPECT_EQ(two.execute(*graph, std::span<NoTrace>(g_none), always), WideGraph::node_count - 1);
    two.finish_activation(*graph);
    ASSERT_EQ(graph->output<Result>().sum, expected->output<Result>().sum);
  }
}

TEST(PlannedExecutor, GoesOnAfterActivationsThatEndEarly) {
  struct StopAfterTheFirst {
    bool go_on(int node) const noexcept { return node > 0; }
  };
  const auto graph = std::make_unique<WideGraph>();
  PlannedExecutor<WideGraph> two(default_schedule<WideGraph>(2), {{"worker"}}, 100'000);
  for (int i = 0; i < 300; ++i) {
    StopAfterTheFirst stop;
    EXPECT_EQ(two.execute(*graph, std::span<NoTrace>(g_none), stop), 0);
    two.finish_activation(*graph);
  }
  NoBoundary always;
  EXPECT_EQ(two.execute(*graph, std::span<NoTrace>(g_none), always), WideGraph::node_count - 1);
  two.finish_activation(*graph);
  EXPECT_EQ(graph->node<Make>().n, 301);
}

TEST(PlannedExecutor, RefusesAPlanThatCannotRun) {
  ScheduleTables<WideGraph> tables = default_schedule<WideGraph>(2);
  --tables.count[1];
  EXPECT_THROW(PlannedExecutor<WideGraph>(tables, {{"worker"}}, 1), std::logic_error);
  EXPECT_THROW(PlannedExecutor<WideGraph>(default_schedule<WideGraph>(2), {}, 1), std::logic_error);
}

}  // namespace
}  // namespace glint::test
