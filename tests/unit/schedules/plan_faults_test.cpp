// Each fault of a schedule with its full message, at the limit and just beyond.
#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <vector>

#include "schedules/plan_check.hpp"

namespace glint::plan_faults_test {
namespace {

using Faults = std::vector<std::string>;

// Frame group: A, then B on the same core and C on the other. Tick group: T.
TaskModel two_groups() {
  TaskModel model;
  model.cores = 2;
  model.groups.resize(2);
  model.groups[0].name = "frame";
  model.groups[0].min_gap_ns = model.groups[0].deadline_ns = 10'000;
  model.groups[0].nodes = {{"A", 0, 1, 100, {}}, {"B", 0, 1, 50, {0}}, {"C", 0, 1, 40, {0}}};
  model.groups[1].name = "tick";
  model.groups[1].min_gap_ns = model.groups[1].deadline_ns = 1'000;
  model.groups[1].nodes = {{"T", 0, 1, 10, {}}};
  model.system.inter_core_delay_ns = 5;
  return model;
}

Plan valid_plan() {
  Plan plan;
  plan.cores = 2;
  plan.groups = {{"frame", 20, 150, 0, false}, {"tick", 30, 10, 0, false}};
  plan.nodes = {{0, 0, 0, 0, 100}, {0, 1, 0, 100, 150}, {0, 2, 1, 105, 145}, {1, 0, 1, 0, 10}};
  return plan;
}

struct Case {
  const char* name;
  std::function<void(Plan&, TaskModel&)> change;
  Faults expected;
};

void expect_faults(const std::vector<Case>& cases) {
  for (const Case& c : cases) {
    Plan plan = valid_plan();
    TaskModel model = two_groups();
    c.change(plan, model);
    EXPECT_EQ(check_plan(plan, model), c.expected) << c.name;
  }
}

TEST(PlanFaults, OfGroupsAreTheirNumberAndPriorities) {
  expect_faults({
      {"valid", [](Plan&, TaskModel&) {}, {}},
      {"a group less",
       [](Plan& p, TaskModel&) { p.groups.pop_back(); },
       {"plan: 1 groups; expected 2"}},
      {"lowest", [](Plan& p, TaskModel&) { p.groups[0].priority = 1; }, {}},
      {"too low",
       [](Plan& p, TaskModel&) { p.groups[0].priority = 0; },
       {"frame: priority 0; expected 1 to 99"}},
      {"highest", [](Plan& p, TaskModel&) { p.groups[1].priority = 99; }, {}},
      {"too high",
       [](Plan& p, TaskModel&) { p.groups[1].priority = 100; },
       {"tick: priority 100; expected 1 to 99"}},
      {"the same",
       [](Plan& p, TaskModel&) { p.groups[0].priority = 30; },
       {"frame and tick: both have priority 30; expected one each"}},
  });
}

TEST(PlanFaults, OfSlicesAreTheirPriorityAndTheirThread) {
  expect_faults({
      {"above",
       [](Plan&, TaskModel& m) { m.groups[1].resumable = true; },
       {"tick: priority 30; expected below 20, that of frame: sliced work has the lowest "
        "priority"}},
      {"level",
       [](Plan& p, TaskModel& m) {
         m.groups[1].resumable = true;
         p.groups[0].priority = 30;
       },
       {"frame and tick: both have priority 30; expected one each",
        "tick: priority 30; expected below 30, that of frame: sliced work has the lowest "
        "priority"}},
      {"below",
       [](Plan& p, TaskModel& m) {
         m.groups[1].resumable = true;
         p.groups[1].priority = 19;
       },
       {}},
      {"on two cores",
       [](Plan&, TaskModel& m) { m.groups[0].resumable = m.groups[1].resumable = true; },
       {"frame: C: core 1; expected 0, as A: sliced work has one thread"}},
  });
}

TEST(PlanFaults, OfPlacesAreEveryNodeOnceOnACoreWithItsTime) {
  expect_faults({
      {"no such node",
       [](Plan& p, TaskModel&) { p.nodes[1].node = 3; },
       {"frame: node 3; expected 0 to 2", "frame: B is missing; expected every node once"}},
      {"a node below 0",
       [](Plan& p, TaskModel&) { p.nodes[3].node = -1; },
       {"tick: node -1; expected 0 to 0", "tick: T is missing; expected every node once"}},
      {"twice",
       [](Plan& p, TaskModel&) { p.nodes.push_back(p.nodes[1]); },
       {"frame: B occurs twice; expected once"}},
      {"no such core",
       [](Plan& p, TaskModel&) { p.nodes[2].core = 2; },
       {"frame: C: core 2; expected 0 to 1"}},
      {"a core below 0",
       [](Plan& p, TaskModel&) { p.nodes[2].core = -1; },
       {"frame: C: core -1; expected 0 to 1"}},
      {"more time", [](Plan& p, TaskModel&) { p.nodes[1].end_ns = 151; }, {}},
      {"less time",
       [](Plan& p, TaskModel&) { p.nodes[1].end_ns = 149; },
       {"frame: B: has 49 ns; expected at least its bound, 50 ns"}},
      {"before the release",
       [](Plan& p, TaskModel&) { p.nodes[3].start_ns = -1; },
       {"tick: T: has 11 ns; expected at least its bound, 10 ns"}},
      {"one of each group",
       [](Plan& p, TaskModel&) {
         p.nodes[0].end_ns = 99;
         p.nodes[3].end_ns = 9;
       },
       {"frame: A: has 99 ns; expected at least its bound, 100 ns",
        "tick: T: has 9 ns; expected at least its bound, 10 ns"}},
  });
}

TEST(PlanFaults, OfOrderAreDataThatIsNotThereAndNodesThatOverlap) {
  expect_faults({
      {"before the hand-over",
       [](Plan& p, TaskModel&) {
         p.nodes[2].start_ns = 104;
         p.nodes[2].end_ns = 144;
       },
       {"frame: C: starts at 104 ns; expected at least 105 ns, when the output of A is ready"}},
      {"one after the other",
       [](Plan& p, TaskModel&) {
         p.nodes[2] = {0, 2, 0, 150, 190};
       },
       {}},
      {"overlap",
       [](Plan& p, TaskModel&) {
         p.nodes[2] = {0, 2, 0, 149, 189};
       },
       {"frame: B and frame: C overlap on core 0; expected one after the other"}},
      {"the other one first",
       [](Plan& p, TaskModel&) {
         p.nodes[2] = {0, 2, 0, 100, 140};
         p.nodes[1] = {0, 1, 0, 140, 190};
       },
       {}},
      {"the other one first, overlap",
       [](Plan& p, TaskModel&) {
         p.nodes[2] = {0, 2, 0, 100, 140};
         p.nodes[1] = {0, 1, 0, 139, 189};
       },
       {"frame: B and frame: C overlap on core 0; expected one after the other"}},
  });
}

// With both of the frame group's nodes on one core, the tick has its own core.
TEST(PlanFaults, OfCapacityAreACoreAboveItsTimeAndAnActivationBeyondTheNext) {
  const auto apart = [](Plan& p) { p.nodes[2] = {0, 2, 0, 150, 190}; };
  expect_faults({
      {"all of a core",
       [&](Plan& p, TaskModel&) {
         apart(p);
         p.nodes[3].end_ns = 1'000;
       },
       {}},
      {"more than a core",
       [&](Plan& p, TaskModel&) {
         apart(p);
         p.nodes[3].end_ns = 1'510;
       },
       {"core 1: used 151 % of the time; expected at most 100 %"}},
      {"no gap",
       [](Plan&, TaskModel& m) { m.groups[1].min_gap_ns = 0; },
       {"core 1: used 1000 % of the time; expected at most 100 %"}},
      {"done as the next comes", [](Plan&, TaskModel& m) { m.groups[0].min_gap_ns = 160; }, {}},
      {"done after the next came",
       [](Plan&, TaskModel& m) { m.groups[0].min_gap_ns = 159; },
       {"frame: an activation may take 160 ns and the next may come after 159 ns; every edge has "
        "one buffer: expected at most 159 ns"}},
      {"never done",
       [](Plan&, TaskModel& m) { m.groups[0].min_gap_ns = 150; },
       {"frame: an activation may take without bound and the next may come after 150 ns; every "
        "edge has one buffer: expected at most 150 ns"}},
  });
}

TEST(PlanFaults, OfTheBusStandBesideAllOthers) {
  const auto busy = [](Plan& p, TaskModel&) {
    p.traffic.tools = 16;
    p.nodes[1].end_ns = 149;
  };
  Plan plan;
  plan.traffic.tools = 16;
  expect_faults({{"bus",
                  busy,
                  {"frame: B: has 49 ns; expected at least its bound, 50 ns",
                   check_bus_load(plan.traffic, plan.bus).value_or("a bus that can carry it")}}});
}

}  // namespace
}  // namespace glint::plan_faults_test
