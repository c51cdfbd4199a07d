#include "schedules/plan_check.hpp"

#include <gtest/gtest.h>

#include <functional>

#include "random_groups.hpp"
#include "schedules/group_response.hpp"
#include "schedules/synthesis.hpp"

namespace glint::plan_check_test {
namespace {

TaskModel small_model(int cores) {
  TaskModel model;
  model.cores = cores;
  TaskGroup frame = tracker_like_group();
  frame.min_gap_ns = frame.deadline_ns = 22'222'222;
  TaskGroup tick = staged_group({{"PredictTools", 1, 20'000}, {"PackCan", 1, 30'000}});
  tick.name = "tick";
  tick.min_gap_ns = tick.deadline_ns = 4'000'000;
  tick.can_writes = 5;
  model.groups = {frame, tick};
  model.system = {20'000, 3'000, 1'000'000, 5'000, 400};
  return model;
}

TEST(PlanCheck, FindsNothingWrongWithASynthesisedPlan) {
  for (const int cores : {1, 2, 4}) {
    const TaskModel model = small_model(cores);
    const Plan plan = synthesize(model);
    const auto faults = check_plan(plan, model);
    EXPECT_TRUE(faults.empty()) << faults.front();
    EXPECT_TRUE(plan.groups[0].optimal);
    EXPECT_GT(plan.groups[1].priority, plan.groups[0].priority);
  }
}

TEST(PlanCheck, FindsNothingWrongWithRandomPlansAndSomethingInEachSpoiltOne) {
  std::mt19937_64 random(5);
  for (int i = 0; i < 100; ++i) {
    TaskModel model;
    model.cores = 1 + i % 4;
    model.groups.push_back(random_group(random, 4 + i % 6, 30));
    model.groups[0].min_gap_ns = model.groups[0].deadline_ns = 1'000;
    model.system.inter_core_delay_ns = i % 3;
    const Plan plan = synthesize(model, 5'000);
    ASSERT_TRUE(check_plan(plan, model).empty()) << check_plan(plan, model).front();
    Plan spoilt = plan;
    PlannedNode& node = spoilt.nodes[random() % spoilt.nodes.size()];
    switch (i % 4) {
      case 0:
        node.end_ns = node.start_ns + model.groups[0].nodes[std::size_t(node.node)].bound_ns - 1;
        break;
      case 1:
        node.core = model.cores;
        break;
      case 2:
        spoilt.nodes.erase(spoilt.nodes.begin());
        break;
      default:
        node.node = (node.node + 1) % int(model.groups[0].nodes.size());
        break;
    }
    EXPECT_FALSE(check_plan(spoilt, model).empty()) << i;
  }
}

TEST(PlanCheck, WantsDataToBeHandedOverBeforeItIsReadOnAnotherCore) {
  TaskModel model;
  model.cores = 2;
  model.groups = {staged_group({{"A", 1, 100}, {"B", 2, 100}})};
  model.groups[0].min_gap_ns = model.groups[0].deadline_ns = 10'000;
  model.system.inter_core_delay_ns = 30;
  Plan plan = synthesize(model);
  ASSERT_TRUE(check_plan(plan, model).empty());
  for (PlannedNode& node : plan.nodes) {
    if (node.core == 0) continue;
    EXPECT_EQ(node.start_ns, 130);
    --node.start_ns;
    --node.end_ns;
  }
  ASSERT_EQ(check_plan(plan, model).size(), 1U);
  EXPECT_NE(check_plan(plan, model)[0].find("expected at least 130 ns"), std::string::npos);
}

struct Spoilt {
  const char* name;
  std::function<void(Plan&, TaskModel&)> spoil;
  const char* said;
};

TEST(PlanCheck, SaysWhatIsWrong) {
  const Spoilt cases[] = {
      {"early",
       [](Plan& p, TaskModel&) {
         p.nodes[1].start_ns = 0;
         p.nodes[1].end_ns = 500;
       },
       "starts at 0 ns; expected at least 300 ns, when the output of StampFrame is ready"},
      {"priority", [](Plan& p, TaskModel&) { p.groups[0].priority = p.groups[1].priority; },
       "both have priority"},
      {"range", [](Plan& p, TaskModel&) { p.groups[0].priority = 100; }, "expected 1 to 99"},
      {"dearer", [](Plan&, TaskModel& m) { m.groups[0].nodes[5].bound_ns += 50'000; },
       "expected at least its bound, "},
      {"gap", [](Plan&, TaskModel& m) { m.groups[0].min_gap_ns = 350'000; },
       "every edge has one buffer: expected at most 350000 ns"},
      {"bus", [](Plan& p, TaskModel&) { p.traffic.tools = 16; }, "of the bus"},
  };
  for (const Spoilt& spoilt : cases) {
    TaskModel model = small_model(2);
    Plan plan = synthesize(model);
    spoilt.spoil(plan, model);
    std::string all;
    for (const std::string& fault : check_plan(plan, model)) all += fault + "\n";
    EXPECT_NE(all.find(spoilt.said), std::string::npos) << spoilt.name << ": " << all;
  }
}

// Fixed orders exclude the scheduling anomalies of a greedy executor: for any execution times and
// any preemption by higher priority, the group ends within its bound.
TEST(GroupResponse, IsNeverExceededBySimulatedActivationsOnSeveralCores) {
  std::mt19937_64 random(1999);
  double closest = 0;
  for (int i = 0; i < 1000; ++i) {
    TaskModel model;
    model.cores = 1 + i % 4;
    model.groups.push_back(random_group(random, 3 + i % 8, 25));
    model.groups[0].min_gap_ns = model.groups[0].deadline_ns = 100'000;
    TaskGroup urgent = staged_group({{"U", 1, 1 + std::int64_t(random() % 9)}});
    urgent.min_gap_ns = 15 + std::int64_t(random() % 60);
    urgent.deadline_ns = urgent.min_gap_ns;
    model.groups.push_back(urgent);
    model.system.inter_core_delay_ns = i % 3;
    const Plan plan = synthesize(model, 2'000);
    const auto bounds = group_responses(model, plan);
    if (!bounds[0].response_ns) continue;

    // Simulates each nanosecond. Both groups are first released at the same time.
    const auto orders = core_orders(plan, 0);
    const int higher_priority_core = [&] {
      for (const PlannedNode& node : plan.nodes) {
        if (node.group == 1) return node.core;
      }
      return -1;
    }();
    const TaskGroup& group = model.groups[0];
    std::vector<std::int64_t> left, end(group.nodes.size(), -1);
    for (const TaskNode& node : group.nodes) {
      left.push_back(i % 2 == 0 ? node.bound_ns
                                : 1 + std::int64_t(random() % std::uint64_t(node.bound_ns)));
    }
    std::vector<std::size_t> next(orders.size(), 0);
    std::vector<int> core_of(group.nodes.size());
    for (std::size_t c = 0; c < orders.size(); ++c) {
      for (const int n : orders[c]) core_of[std::size_t(n)] = int(c);
    }
    std::int64_t urgent_left = 0, now = 0, done = 0;
    for (; done < std::int64_t(group.nodes.size()) && now < 1'000'000; ++now) {
      if (now % urgent.min_gap_ns == 0) urgent_left += urgent.nodes[0].bound_ns;
      for (std::size_t c = 0; c < orders.size(); ++c) {
        if (int(c) == higher_priority_core && urgent_left > 0) {
          --urgent_left;
          continue;
        }
        if (next[c] == orders[c].size()) continue;
        const auto n = std::size_t(orders[c][next[c]]);
        bool there = true;
        for (const int b : group.nodes[n].after) {
          const auto before = std::size_t(b);
          const std::int64_t handed =
              core_of[before] == int(c) ? 0 : model.system.inter_core_delay_ns;
          there = there && end[before] >= 0 && end[before] + handed <= now;
        }
        if (!there || --left[n] > 0) continue;
        end[n] = now + 1;
        ++next[c];
        ++done;
      }
    }
    EXPECT_LE(now, *bounds[0].response_ns) << i;
    closest = std::max(closest, double(now) / double(*bounds[0].response_ns));
  }
  EXPECT_EQ(closest, 1.0);  // some activations reach their bound
}

TEST(GroupResponse, CountsWakeUpsInterruptsWritesAndSlices) {
  TaskModel model = small_model(1);
  const Plan plan = synthesize(model);
  const auto with = group_responses(model, plan);
  // 50 us of nodes, 5 writes of 5 us, a wake-up of 20 us, one interrupt of 3 us.
  EXPECT_EQ(with[1].response_ns, 50'000 + 25'000 + 20'000 + 3'000);
  model.system = {};
  EXPECT_EQ(group_responses(model, plan)[1].response_ns, 50'000);
  model.groups[0].longest_slice_ns = 70'000;
  EXPECT_EQ(group_responses(model, plan)[1].response_ns, 120'000);
  EXPECT_EQ(group_responses(model, plan)[1].blocking_ns, 70'000);
}

// The first worker wakes at the release, then wakes the others.
TEST(GroupResponse, CountsOneWakeUpOnOneCoreAndTwoOnSeveral) {
  for (const int cores : {1, 2}) {
    TaskModel model;
    model.cores = cores;
    model.groups.push_back(staged_group({{"Half", 2, 100}}));
    model.groups[0].min_gap_ns = model.groups[0].deadline_ns = 10'000;
    model.system.wake_up_ns = 7;
    const auto found = group_responses(model, synthesize(model));
    ASSERT_EQ(found[0].times.cores_used, cores);
    EXPECT_EQ(found[0].response_ns, cores == 1 ? 200 + 7 : 100 + 2 * 7);
  }
}

// One release of the higher-priority group is delayed, the next is not: both are in one window.
TEST(GroupResponse, CountsAnUrgentGroupsJitterAndWakeUpAmongItsReleases) {
  TaskModel model;
  model.groups.push_back(staged_group({{"Slow", 1, 83}}));
  model.groups[0].min_gap_ns = model.groups[0].deadline_ns = 10'000;
  model.groups.push_back(staged_group({{"Urgent", 1, 10}}));
  model.groups[1].min_gap_ns = model.groups[1].deadline_ns = 100;
  const Plan plan = synthesize(model);
  ASSERT_GT(plan.groups[1].priority, plan.groups[0].priority);
  const auto response = [&](std::int64_t jitter_ns, std::int64_t wake_up_ns) {
    model.groups[1].jitter_ns = jitter_ns;
    model.system.wake_up_ns = wake_up_ns;
    return group_responses(model, plan)[0].response_ns;
  };
  // Own work and wake-up, and one or two releases of the higher-priority group, with its jitter.
  EXPECT_EQ(response(0, 0), 83 + 10);
  EXPECT_EQ(response(0, 3), 86 + 10);
  EXPECT_EQ(response(0, 4), 87 + 2 * 10) << "97 + 4 are more than its gap";
  EXPECT_EQ(response(7, 0), 83 + 10);
  EXPECT_EQ(response(8, 0), 83 + 2 * 10);
  EXPECT_EQ(response(2, 3), 86 + 2 * 10);
}

TEST(Synthesis, GivesTheTickTheHigherPriorityOnlyWhereItNeedsIt) {
  TaskModel model = small_model(1);
  model.groups[0].deadline_ns = 1'000'000;  // now the frame group has the higher priority
  model.groups[1].deadline_ns = 4'000'000;
  const Plan plan = synthesize(model);
  EXPECT_GT(plan.groups[0].priority, plan.groups[1].priority);
}

}  // namespace
}  // namespace glint::plan_check_test
