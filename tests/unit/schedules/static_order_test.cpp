// Static orders: start and end times, levels, list schedules and lower bounds.
#include "schedules/static_order.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>

#include "random_groups.hpp"
#include "schedules/list_schedule.hpp"
#include "schedules/makespan_bound.hpp"

namespace glint::static_order_test {
namespace {

using Times = std::vector<std::int64_t>;

// A (10), then B (20) and C (30) in parallel, then D (5).
TaskGroup diamond() {
  TaskGroup group;
  group.nodes = {
      {"A", 0, 1, 10, {}}, {"B", 0, 1, 20, {0}}, {"C", 0, 1, 30, {0}}, {"D", 0, 1, 5, {1, 2}}};
  return group;
}

TEST(TimesOf, HandOverOnlyBetweenCores) {
  const auto times = times_of(diamond(), {{0, 2, 3}, {1}}, 4);
  ASSERT_TRUE(times);
  EXPECT_EQ(times->start_ns, (Times{0, 14, 10, 40}));
  EXPECT_EQ(times->end_ns, (Times{10, 34, 40, 45}));
  EXPECT_EQ(times->core, (std::vector<int>{0, 1, 0, 0}));
  EXPECT_EQ(times->makespan_ns, 45);
  EXPECT_EQ(times->cores_used, 2);
  const auto later = times_of(diamond(), {{0, 1, 3}, {2}}, 4);
  ASSERT_TRUE(later);
  EXPECT_EQ(later->start_ns, (Times{0, 10, 14, 48})) << "D waits for what C hands over";
  EXPECT_EQ(later->makespan_ns, 53);
}

TEST(TimesOf, RunOneNodeAfterTheOtherOnOneCore) {
  const auto times = times_of(diamond(), {{}, {0, 2, 1, 3}, {}}, 1'000);
  ASSERT_TRUE(times);
  EXPECT_EQ(times->start_ns, (Times{0, 40, 10, 60}));
  EXPECT_EQ(times->makespan_ns, 65);
  EXPECT_EQ(times->cores_used, 1);
  EXPECT_EQ(times->core, (std::vector<int>{1, 1, 1, 1}));
}

TEST(TimesOf, AreNoneWhereOrdersAndDataWaitForEachOther) {
  EXPECT_FALSE(times_of(diamond(), {{1, 0, 2, 3}}, 0)) << "B before what it reads";
  // Deadlock: each core's first node reads the output of the other core's second.
  TaskGroup crossed;
  crossed.nodes = {
      {"A", 0, 1, 1, {}}, {"B", 0, 1, 1, {}}, {"C", 0, 1, 1, {0}}, {"D", 0, 1, 1, {1}}};
  EXPECT_FALSE(times_of(crossed, {{2, 1}, {3, 0}}, 0));
  EXPECT_TRUE(times_of(crossed, {{0, 3}, {1, 2}}, 0));
}

TEST(TimesOf, LeaveOutANodeThatNoCoreRuns) {
  const auto times = times_of(diamond(), {{0, 1}}, 0);
  ASSERT_TRUE(times);
  EXPECT_EQ(times->core, (std::vector<int>{0, 0, -1, -1}));
  EXPECT_EQ(times->makespan_ns, 30);
  EXPECT_FALSE(times_of(diamond(), {{0, 1, 3}}, 0)) << "D reads C, which never runs";
}

TEST(Levels, AreTheLongestPathsToTheEnd) {
  EXPECT_EQ(levels_of(diamond()), (Times{45, 25, 35, 5}));
}

TEST(ListSchedule, TakesTheHighestLevelFirstToTheCoreWhereItStartsFirst) {
  // C has a higher level than B and runs on A's core. B starts earlier on the other core.
  EXPECT_EQ(list_schedule(diamond(), 2, 4), (CoreOrders{{0, 2, 3}, {1}}));
  // With an inter-core delay equal to C, B runs after C: of equal cores the first is chosen.
  EXPECT_EQ(list_schedule(diamond(), 2, 30), (CoreOrders{{0, 2, 1, 3}, {}}));
  EXPECT_EQ(list_schedule(diamond(), 2, 29), (CoreOrders{{0, 2}, {1, 3}}));
}

TEST(ListSchedule, KeepsTheListedOrderAmongEqualLevels) {
  const TaskGroup equal = staged_group({{"Copy", 4, 10}});
  EXPECT_EQ(list_schedule(equal, 1, 0), (CoreOrders{{0, 1, 2, 3}}));
  EXPECT_EQ(list_schedule(equal, 3, 0), (CoreOrders{{0, 3}, {1}, {2}}));
}

// Reference: an independent search from each node along its readers.
TEST(Reach, IsWhateverNeedsANodeDirectlyOrNot) {
  std::mt19937_64 random(11);
  for (int i = 0; i < 50; ++i) {
    const TaskGroup group = random_group(random, 3 + i % 8, 10 + i % 40);
    const Reach reach = reach_of(group);
    for (std::size_t u = 0; u < group.nodes.size(); ++u) {
      std::vector<bool> found(group.nodes.size(), false);
      const std::function<void(std::size_t)> visit = [&](std::size_t from) {
        for (std::size_t v = 0; v < group.nodes.size(); ++v) {
          const std::vector<int>& after = group.nodes[v].after;
          if (std::find(after.begin(), after.end(), static_cast<int>(from)) == after.end())
            continue;
          found[v] = true;
          visit(v);
        }
      };
      visit(u);
      EXPECT_EQ(reach[u], found) << i << ", node " << u;
    }
  }
}

TEST(LeastBetween, IsTheBestNumberOfCoresEachOfWhichButOnePaysTwoHandOvers) {
  EXPECT_EQ(time_between_min(0, 4, 3), 0);
  EXPECT_EQ(time_between_min(30, 1, 0), 30);
  EXPECT_EQ(time_between_min(31, 2, 0), 16) << "rounded up";
  EXPECT_EQ(time_between_min(30, 3, 0), 10);
  EXPECT_EQ(time_between_min(30, 3, 1), 12);   // 34 / 3
  EXPECT_EQ(time_between_min(30, 3, 10), 24);  // 70 / 3
  EXPECT_EQ(time_between_min(30, 2, 10), 25);
  EXPECT_EQ(time_between_min(30, 3, 15), 30) << "one core";
}

TEST(Tails, AddWorkBetweenANodeAndALaterOneOnAllCores) {
  const TaskGroup fork = staged_group({{"A", 1, 10}, {"B", 3, 10}, {"C", 1, 10}});
  const auto tails = [&](std::int64_t core_delay) {
    return tails_of(fork, reach_of(fork), 2, core_delay);
  };
  EXPECT_EQ(tails(0), (Times{35, 20, 20, 20, 10}));   // 30 of the copies on two cores
  EXPECT_EQ(tails(5), (Times{40, 20, 20, 20, 10}));   // (30 + 10) / 2
  EXPECT_EQ(tails(50), (Times{50, 20, 20, 20, 10}));  // in sequence
}

// No node after the copies reads them, so no inter-core delay counts.
TEST(Tails, AddAllWorkThatFollowsANodeToTheEnd) {
  const TaskGroup fan = staged_group({{"A", 1, 10}, {"B", 5, 10}});
  EXPECT_EQ(tails_of(fan, reach_of(fan), 2, 1'000), (Times{35, 10, 10, 10, 10, 10}));
  EXPECT_EQ(tails_of(fan, reach_of(fan), 1, 0)[0], 60);
}

TEST(CoreOrders, AreThePlansNodesOfAGroupByStart) {
  Plan plan;
  plan.cores = 3;
  plan.nodes = {
      {1, 0, 0, 0, 9}, {0, 2, 2, 50, 60}, {0, 0, 2, 10, 20}, {0, 3, 0, 10, 10}, {0, 1, 0, 10, 30}};
  EXPECT_EQ(core_orders(plan, 0), (CoreOrders{{3, 1}, {}, {0, 2}})) << "equal starts stay";
  EXPECT_EQ(core_orders(plan, 1), (CoreOrders{{0}, {}, {}}));
  EXPECT_EQ(core_orders(plan, 2), (CoreOrders{{}, {}, {}}));
  plan.cores = 0;
  EXPECT_EQ(core_orders(plan, 2).size(), 1U);
}

TEST(NodeName, NumbersTheCopiesOfASplitAlone) {
  EXPECT_EQ(node_name({"FindBlobs", 0, 1, 5, {}}), "FindBlobs");
  EXPECT_EQ(node_name({"RoiThreshold", 1, 2, 5, {}}), "RoiThreshold#1");
}

}  // namespace
}  // namespace glint::static_order_test
