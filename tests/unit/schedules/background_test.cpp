// Background group that runs in slices: lowest priority whatever its deadline, allocated to the
// core where it blocks least; its effect on responses, stages and slack.
#include <gtest/gtest.h>

#include <algorithm>

#include "fixed_priority_simulator.hpp"
#include "random_groups.hpp"
#include "schedules/assessment.hpp"
#include "schedules/group_response.hpp"
#include "schedules/plan_check.hpp"
#include "schedules/sensitivity.hpp"
#include "schedules/synthesis.hpp"

namespace glint::background_test {
namespace {

constexpr std::int64_t k_us = 1'000, k_ms = 1'000'000;
constexpr std::size_t k_frame = 0, k_tick = 1, k_background = 2;

TaskGroup background_group(std::int64_t slice_ns, std::int64_t period_ns) {
  TaskGroup group = staged_group({{"Slice", 1, slice_ns}});
  group.name = "background";
  group.resumable = true;
  group.longest_slice_ns = slice_ns;
  group.min_gap_ns = group.deadline_ns = period_ns;
  return group;
}

TaskModel three_groups(int cores, std::int64_t slice_ns = 300 * k_us,
                       std::int64_t period_ns = 100 * k_ms) {
  TaskModel model;
  model.cores = cores;
  TaskGroup frame = tracker_like_group();
  frame.min_gap_ns = frame.deadline_ns = 22'222'222;
  TaskGroup tick = staged_group({{"PredictTools", 1, 20 * k_us}, {"PackCan", 1, 30 * k_us}});
  tick.name = "tick";
  tick.min_gap_ns = tick.deadline_ns = 4 * k_ms;
  model.groups = {frame, tick, background_group(slice_ns, period_ns)};
  model.system.inter_core_delay_ns = 400;
  return model;
}

int core_of(const Plan& plan, std::size_t group) {
  for (const PlannedNode& node : plan.nodes) {
    if (node.group == static_cast<int>(group)) return node.core;
  }
  return -1;
}

TEST(BackgroundPlan, IsOptimalForEachOfThreeGroupsOnOneCoreAndOnSeveral) {
  for (const int cores : {1, 2, 4}) {
    const TaskModel model = three_groups(cores);
    const Plan plan = synthesize(model);
    const auto faults = check_plan(plan, model);
    EXPECT_TRUE(faults.empty()) << faults.front();
    ASSERT_EQ(plan.groups.size(), 3U);
    for (const PlannedGroup& group : plan.groups) {
      EXPECT_TRUE(group.optimal) << group.name << " on " << cores;
      EXPECT_EQ(group.makespan_ns, group.makespan_lower_bound_ns);
    }
  }
}

// The two nodes are independent, but one thread runs all slices.
TEST(BackgroundPlan, KeepsASlicesNodesOnOneCore) {
  TaskModel model = three_groups(2);
  TaskNode second = model.groups[k_background].nodes[0];
  second.name = "Second";
  second.after.clear();
  model.groups[k_background].nodes.push_back(second);
  Plan plan = synthesize(model);
  EXPECT_TRUE(check_plan(plan, model).empty());
  int first_core = -1;
  for (const PlannedNode& node : plan.nodes) {
    if (node.group != static_cast<int>(k_background)) continue;
    if (first_core < 0) first_core = node.core;
    EXPECT_EQ(node.core, first_core);
  }
  PlannedNode& moved = plan.nodes.back();
  ASSERT_EQ(moved.group, static_cast<int>(k_background));
  moved.core = 1 - moved.core;
  const auto faults = check_plan(plan, model);
  ASSERT_EQ(faults.size(), 1U);
  EXPECT_NE(faults[0].find("sliced work has one thread"), std::string::npos) << faults[0];
}

TEST(BackgroundPlan, GivesSlicesTheLowestPriorityWhateverTheirDeadline) {
  for (const std::int64_t period : {2 * k_ms, 10 * k_ms, 1'000 * k_ms}) {
    const TaskModel model = three_groups(1, 100 * k_us, period);
    const Plan plan = synthesize(model);
    EXPECT_LT(plan.groups[k_background].priority, plan.groups[k_frame].priority) << period;
    EXPECT_LT(plan.groups[k_background].priority, plan.groups[k_tick].priority) << period;
  }
}

TEST(BackgroundPlan, IsRefusedWithSlicesAboveAnotherGroup) {
  const TaskModel model = three_groups(2);
  Plan plan = synthesize(model);
  plan.groups[k_background].priority = plan.groups[k_frame].priority + 1;
  const auto faults = check_plan(plan, model);
  ASSERT_EQ(faults.size(), 1U);
  EXPECT_EQ(faults[0],
            "background: priority 46; expected below 45, that of frame: sliced work has the lowest "
            "priority");
}

// The frame group uses both cores, so its response does not depend on the slices' core. The tick
// decides even where the frame group has less slack.
TEST(BackgroundPlan, PutsSlicesOnTheCoreWhereTheTickDoesNotRun) {
  TaskModel model = three_groups(2);
  for (const std::int64_t frame_deadline : {22'222 * k_us, 800 * k_us}) {
    model.groups[k_frame].deadline_ns = frame_deadline;
    const Plan plan = synthesize(model);
    const auto found = group_responses(model, plan);
    ASSERT_TRUE(found[k_frame].meets_deadline() && found[k_tick].meets_deadline());
    EXPECT_NE(core_of(plan, k_background), core_of(plan, k_tick)) << frame_deadline;
    EXPECT_EQ(found[k_tick].blocking_ns, 0);
  }
}

TEST(BackgroundPlan, MovedByHandToTheTicksCoreStillRunsAndBlocksTheTick) {
  const TaskModel model = three_groups(2);
  Plan plan = synthesize(model);
  const auto before = group_responses(model, plan);
  for (PlannedNode& node : plan.nodes) {
    if (node.group == static_cast<int>(k_background)) node.core = core_of(plan, k_tick);
  }
  EXPECT_TRUE(check_plan(plan, model).empty());
  const auto after = group_responses(model, plan);
  EXPECT_EQ(after[k_tick].blocking_ns, 300 * k_us);
  EXPECT_EQ(*after[k_tick].response_ns, *before[k_tick].response_ns + 300 * k_us);
  EXPECT_EQ(after[k_frame].blocking_ns, 300 * k_us);
}

TEST(BackgroundPlan, ThatHasNoRoomForItsSlicesIsRefused) {
  const TaskModel model = three_groups(1, 900 * k_us, 1 * k_ms);
  const auto faults = check_plan(synthesize(model), model);
  ASSERT_FALSE(faults.empty());
  EXPECT_NE(faults[0].find("background: an activation may take "), std::string::npos) << faults[0];
}

TEST(BackgroundStages, HaveARowForTheSliceAndAddUpToTheSame) {
  const auto input_with = [](std::int64_t slice_ns) {
    AnalysisInput input;
    input.model = three_groups(1, slice_ns);
    input.plan = synthesize(input.model);
    input.frame_to_can_deadline_ns = input.age_deadline_ns = 250 * k_ms;
    return input;
  };
  const Chain with = assess(input_with(300 * k_us)).chains.at(0);
  AnalysisInput without = input_with(300 * k_us);
  without.model.groups.pop_back();
  without.plan = synthesize(without.model);
  const Chain alone = assess(without).chains.at(0);
  const auto row = [](const Chain& chain, const std::string& name) {
    std::int64_t ns = 0;
    for (const ChainStage& stage : chain.stages) ns += stage.name == name ? stage.ns : 0;
    return ns;
  };
  for (const char* const group : {"frame", "tick"}) {
    EXPECT_EQ(row(with, std::string(group) + ": blocked by a slice"), 300 * k_us);
    EXPECT_EQ(row(with, std::string(group) + ": nodes and preemption"),
              row(alone, std::string(group) + ": nodes and preemption"));
  }
  EXPECT_EQ(with.stages.size(), alone.stages.size() + 2);
  EXPECT_EQ(with.total_ns, alone.total_ns + 2 * 300 * k_us);
  std::int64_t sum = 0;
  for (const ChainStage& stage : with.stages) sum += stage.ns;
  EXPECT_EQ(with.total_ns, sum);
}

TEST(BackgroundSlack, EndsWhereALongerSliceMakesAGroupLate) {
  AnalysisInput input;
  input.model = three_groups(1);
  input.plan = synthesize(input.model);
  input.frame_to_can_deadline_ns = input.age_deadline_ns = 250 * k_ms;
  const IsScaled slices = [](std::size_t group, std::size_t) { return group == k_background; };
  const auto factor = largest_factor(input, slices);
  ASSERT_TRUE(factor);
  // A slice of 300 us may grow to the tick's 4 ms minus its own 50 us.
  EXPECT_NEAR(*factor, 3'950.0 / 300, 0.01);
  input.model = scaled(input.model, *factor * 1.001, slices);
  EXPECT_FALSE(assess(input).holds());
}

TEST(BackgroundSlack, TakesASliceOfSeveralNodesForLongerWithAnyAndShorterOnlyWithAll) {
  TaskModel model = three_groups(1);
  model.groups[k_background] = staged_group({{"A", 1, 100}, {"B", 1, 100}});
  model.groups[k_background].longest_slice_ns = 200;
  const auto slice = [&](double factor, bool both) {
    return scaled(model, factor,
                  [&](std::size_t group, std::size_t node) {
                    return group == k_background && (both || node == 0);
                  })
        .groups[k_background]
        .longest_slice_ns;
  };
  EXPECT_EQ(slice(2, false), 400);
  EXPECT_EQ(slice(0.5, false), 200);
  EXPECT_EQ(slice(0.5, true), 100);
}

// Slices that cannot be preempted at all: the worst case of blocking.
TEST(BackgroundResponse, OfNoGroupIsExceededInAThousandSimulatedSets) {
  std::mt19937_64 random(22);
  double closest = 0;
  int bounded = 0;
  for (int i = 0; i < 1000; ++i) {
    const auto up_to = [&](std::int64_t most) {
      return 1 + static_cast<std::int64_t>(random() % static_cast<std::uint64_t>(most));
    };
    TaskModel model;
    model.groups = {staged_group({{"F", 1, up_to(30)}}), staged_group({{"T", 1, up_to(8)}}),
                    background_group(up_to(20), 150 + up_to(150))};
    model.groups[k_frame].min_gap_ns = model.groups[k_frame].deadline_ns = 80 + up_to(40);
    model.groups[k_tick].name = "tick";
    model.groups[k_tick].min_gap_ns = model.groups[k_tick].deadline_ns = 20 + up_to(20);
    const Plan plan = synthesize(model);
    const auto bounds = group_responses(model, plan);
    std::vector<std::size_t> urgent_first = {k_frame, k_tick, k_background};
    std::sort(urgent_first.begin(), urgent_first.end(), [&](std::size_t a, std::size_t b) {
      return plan.groups[a].priority > plan.groups[b].priority;
    });
    std::vector<SimulatedTask> tasks;
    for (const std::size_t g : urgent_first) {
      const TaskGroup& group = model.groups[g];
      tasks.push_back({group.nodes[0].bound_ns, group.min_gap_ns, 0, group.longest_slice_ns,
                       g == k_background ? 0 : up_to(3)});
    }
    const auto seen = simulate(
        tasks, 20'000, [](std::size_t, std::int64_t) { return std::int64_t{0}; },
        [&](std::size_t t, std::int64_t) { return tasks[t].cost; });
    for (std::size_t rank = 0; rank < 3; ++rank) {
      const auto& bound = bounds[urgent_first[rank]].response_ns;
      if (!bound) continue;
      ++bounded;
      EXPECT_LE(seen[rank], *bound) << i;
      closest = std::max(closest, double(seen[rank]) / double(*bound));
    }
  }
  EXPECT_GT(bounded, 2'500);
  EXPECT_GT(closest, 0.95);
}

}  // namespace
}  // namespace glint::background_test
