// Priorities and allocations of a synthesised schedule, calculated by hand.
#include "schedules/synthesis.hpp"

#include <gtest/gtest.h>

#include <set>

#include "random_groups.hpp"
#include "schedules/group_response.hpp"
#include "schedules/plan_check.hpp"

namespace glint::synthesis_test {
namespace {

TaskGroup one_node(const char* name, std::int64_t bound_ns, std::int64_t deadline_ns) {
  TaskGroup group = staged_group({{"N", 1, bound_ns}});
  group.name = name;
  group.min_gap_ns = 1'000;
  group.deadline_ns = deadline_ns;
  return group;
}

std::vector<int> priorities(const std::vector<TaskGroup>& groups) {
  TaskModel model;
  model.groups = groups;
  std::vector<int> found;
  for (const PlannedGroup& group : synthesize(model).groups) found.push_back(group.priority);
  return found;
}

TEST(Priorities, FollowDeadlinesThreeApart) {
  EXPECT_EQ(
      priorities({one_node("slow", 5, 300), one_node("fast", 5, 100), one_node("middle", 5, 200)}),
      (std::vector<int>{42, 48, 45}));
}

TEST(Priorities, OfEqualDeadlinesKeepTheListedOrder) {
  EXPECT_EQ(priorities({one_node("a", 5, 100), one_node("b", 5, 100), one_node("c", 5, 100)}),
            (std::vector<int>{48, 45, 42}));
}

// Jitter leaves 5 of the longer deadline for work of 5; the shorter deadline leaves 10.
TEST(Priorities, LeaveTheOrderOfDeadlinesWhereOnlyAnotherIsInTime) {
  TaskGroup late = one_node("late", 5, 20);
  late.jitter_ns = 15;
  EXPECT_EQ(priorities({one_node("early", 5, 10), late}), (std::vector<int>{45, 48}));
  EXPECT_EQ(priorities({late, one_node("early", 5, 10)}), (std::vector<int>{48, 45}));
  // A third group below both: only it can have the lowest priority.
  EXPECT_EQ(priorities({one_node("last", 5, 900), one_node("early", 5, 10), late}),
            (std::vector<int>{42, 45, 48}));
}

TEST(Priorities, FollowDeadlinesWhereNoOrderIsInTime) {
  EXPECT_EQ(priorities({one_node("longer", 5, 7), one_node("shorter", 5, 6)}),
            (std::vector<int>{45, 48}));
}

TEST(Synthesis, PutsTheFirstNodeOnTheFirstCore) {
  TaskModel model;
  model.cores = 2;
  TaskGroup group;
  group.name = "frame";
  group.nodes = {{"Short", 0, 1, 10, {}}, {"Long", 0, 1, 100, {}}, {"After", 0, 1, 5, {1}}};
  group.min_gap_ns = group.deadline_ns = 1'000;
  model.groups = {group};
  const Plan plan = synthesize(model);
  EXPECT_EQ(plan.cores, 2);
  EXPECT_EQ(core_orders(plan, 0), (CoreOrders{{0}, {1, 2}}));
  EXPECT_EQ(plan.groups[0].name, "frame");
  EXPECT_EQ(plan.groups[0].makespan_ns, 105);
  EXPECT_EQ(plan.groups[0].makespan_lower_bound_ns, 105);
  EXPECT_TRUE(plan.groups[0].optimal);
  ASSERT_EQ(plan.nodes.size(), 3U);
  for (const PlannedNode& node : plan.nodes) {
    EXPECT_EQ(node.start_ns, node.node == 2 ? 100 : 0) << node.node;
    EXPECT_EQ(node.end_ns, node.start_ns + group.nodes[std::size_t(node.node)].bound_ns);
  }
}

int core_of(const Plan& plan, int group) {
  for (const PlannedNode& node : plan.nodes) {
    if (node.group == group) return node.core;
  }
  return -1;
}

// On the frame group's core the tick would delay it. On the tick's core the slices would make the
// tick miss its deadline.
TEST(Synthesis, PutsEachGroupWhereTheTightestResponseIsBest) {
  TaskModel model;
  model.groups = {one_node("frame", 100, 200), one_node("tick", 50, 60),
                  one_node("slices", 30, 900)};
  model.groups[2].resumable = true;
  model.groups[2].longest_slice_ns = 30;
  for (const int cores : {1, 2, 3}) {
    model.cores = cores;
    const Plan plan = synthesize(model);
    EXPECT_TRUE(check_plan(plan, model).empty()) << cores;
    EXPECT_EQ(core_of(plan, 0), 0);
    std::set<int> used;
    for (int g = 0; g < 3; ++g) used.insert(core_of(plan, g));
    EXPECT_EQ(static_cast<int>(used.size()), cores);
    if (cores == 3) {
      EXPECT_EQ(core_of(plan, 1), 1) << "of places that are as good, the first that is tried";
      EXPECT_EQ(core_of(plan, 2), 2);
    }
    EXPECT_EQ(core_of(plan, 2) == 0, cores < 3) << "of two the tick has the other to itself";
  }
}

TEST(Synthesis, AvoidsAPlaceWithoutABound) {
  TaskModel model;
  model.cores = 2;
  model.groups = {one_node("frame", 900, 1'000), one_node("tick", 300, 1'000)};
  model.groups[1].min_gap_ns = 600;
  const Plan plan = synthesize(model);
  EXPECT_NE(core_of(plan, 0), core_of(plan, 1));
}

// Bounds of another board file: the same orders, other times.
TEST(Retimed, KeepsOrdersAndTakesTheModelsBounds) {
  TaskModel model;
  model.cores = 2;
  model.groups = {staged_group({{"A", 1, 10}, {"B", 2, 20}, {"C", 1, 5}}),
                  one_node("tick", 7, 500)};
  model.groups[0].min_gap_ns = model.groups[0].deadline_ns = 1'000;
  model.system.inter_core_delay_ns = 3;
  const Plan plan = synthesize(model);
  TaskModel slower = model;
  slower.system.inter_core_delay_ns = 4;
  for (TaskGroup& group : slower.groups) {
    for (TaskNode& node : group.nodes) node.bound_ns *= 2;
  }
  const Plan found = with_computed_times(plan, slower);
  EXPECT_TRUE(check_plan(found, slower).empty()) << check_plan(found, slower).front();
  for (int g = 0; g < 2; ++g) {
    EXPECT_EQ(core_orders(found, g), core_orders(plan, g));
    EXPECT_EQ(found.groups[std::size_t(g)].priority, plan.groups[std::size_t(g)].priority);
  }
  EXPECT_EQ(plan.groups[0].makespan_ns, 10 + 3 + 20 + 5);
  EXPECT_EQ(found.groups[0].makespan_ns, 20 + 4 + 40 + 10);
  EXPECT_EQ(found.groups[1].makespan_ns, 14);
  const Plan same = with_computed_times(plan, model);
  ASSERT_EQ(same.nodes.size(), plan.nodes.size());
  for (std::size_t n = 0; n < plan.nodes.size(); ++n) {
    EXPECT_EQ(same.nodes[n].start_ns, plan.nodes[n].start_ns);
    EXPECT_EQ(same.nodes[n].end_ns, plan.nodes[n].end_ns);
  }
}

}  // namespace
}  // namespace glint::synthesis_test
