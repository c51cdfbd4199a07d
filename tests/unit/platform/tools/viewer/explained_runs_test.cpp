// Explanations of simulated runs in which one thing is wrong.
#include <gtest/gtest.h>

#include <algorithm>

#include "platform/cells/tool_file.hpp"
#include "tests/unit/platform/tools/viewer/collected_messages.hpp"

namespace glint::explained_runs_test {
namespace {

using Explanations = std::vector<ExplainedAt>;

constexpr double k_settled_s = 0.6;  // of this time, the tracker and its first diagnosis

// The share of a condition over the run's messages after a time.
template <class Holds>
double share_of(const Explanations& all, double from_s, double to_s, Holds holds) {
  int count = 0, holding = 0;
  for (const ExplainedAt& one : all) {
    if (one.time_s < from_s || one.time_s >= to_s) continue;
    ++count;
    holding += holds(one) ? 1 : 0;
    if (!holds(one))
      std::printf("%.3f s: %s: %s\n", one.time_s, one.state.c_str(), one.text.c_str());
  }
  EXPECT_GT(count, 0) << "no explanation between " << from_s << " and " << to_s << " s";
  return count == 0 ? 0 : static_cast<double>(holding) / count;
}

auto contains(const std::string& part) {
  return [part](const ExplainedAt& one) { return one.text.find(part) != std::string::npos; };
}

TEST(ExplainedRun, OfAVisiblePenIsTracked) {
  const Cell cell = short_cell(3);
  sim::Scenario scenario = scenario_of(cell);
  scenario.occlusions.clear();
  scenario.absences.clear();
  const Explanations all = explanations_of(collected_run(cell, scenario));
  EXPECT_GT(share_of(all, k_settled_s, 3, contains("Tracked by ")), 0.99);
  // At each change and at least once a second.
  for (std::size_t i = 1; i < all.size(); ++i) {
    EXPECT_LE(all[i].time_s - all[i - 1].time_s, 1.1);
    EXPECT_GE(all[i].time_s - all[i - 1].time_s, 0.099);
  }
}

TEST(ExplainedRun, OfAThresholdAboveAllPixelsNamesIt) {
  Cell cell = short_cell(2);
  sim::Scenario scenario = scenario_of(cell);
  scenario.clutter.clear();
  scenario.absences = {{{Time{}, Time{} + milliseconds(3000)}, 0}};
  cell.camera.threshold = 65000;
  const Explanations all = explanations_of(collected_run(cell, scenario));
  EXPECT_EQ(share_of(all, k_settled_s, 2, contains("exceeds the threshold of 65000")), 1);
}

TEST(ExplainedRun, OfAThresholdAboveTheMarkersNamesTheOneThatFindsThem) {
  for (const std::uint16_t threshold : {std::uint16_t{30000}, std::uint16_t{65000}}) {
    Cell cell = short_cell(2);
    sim::Scenario scenario = scenario_of(cell);
    scenario.occlusions.clear();
    scenario.absences.clear();
    cell.camera.threshold = threshold;
    const Explanations all = explanations_of(collected_run(cell, scenario));
    EXPECT_GT(share_of(all, k_settled_s, 2, contains("Set [camera] threshold = ")), 0.9)
        << threshold;
  }
}

TEST(ExplainedRun, OfAThresholdBelowTheRoomNamesIt) {
  Cell cell = short_cell(2);
  cell.camera.threshold = 5;
  const Explanations all = explanations_of(collected_run(cell, scenario_of(cell)));
  EXPECT_GT(share_of(all, k_settled_s, 2, contains("of the picture exceed the threshold of 5")),
            0.9);
}

TEST(ExplainedRun, OfAnotherToolNamesTheOneInView) {
  Cell cell = short_cell(2);
  sim::Scenario scenario = scenario_of(cell);
  scenario.occlusions.clear();
  scenario.absences.clear();
  cell.tools.items[0] = *built_in_tool("board");
  const Explanations all = explanations_of(collected_run(cell, scenario));
  EXPECT_GT(share_of(all, k_settled_s, 2, contains("they fit the tool \"pen\"")), 0.9);
}

TEST(ExplainedRun, OfAHandBeforeThePenSaysThatItsMarkersAreNotVisible) {
  const Cell cell = short_cell(4);
  sim::Scenario scenario = scenario_of(cell);
  scenario.absences.clear();
  scenario.occlusions = {{{Time{} + milliseconds(1500), Time{} + milliseconds(3000)}, 0}};
  const Explanations all = explanations_of(collected_run(cell, scenario));
  EXPECT_GT(share_of(all, k_settled_s, 1.4, contains("Tracked by ")), 0.99);
  EXPECT_GT(share_of(all, 2.2, 2.9, contains("visible")), 0.9);
  const auto predicted = [](const ExplainedAt& one) { return one.state == "predicted"; };
  EXPECT_TRUE(std::any_of(all.begin(), all.end(), predicted));
  EXPECT_GT(share_of(all, 3.6, 4, contains("Tracked by ")), 0.9);
}

TEST(ExplainedRun, OfAPenThatLeavesSaysSo) {
  const Cell cell = short_cell(4);
  sim::Scenario scenario = scenario_of(cell);
  scenario.occlusions.clear();
  scenario.absences = {
      {{Time{} + milliseconds(1500), Time{} + milliseconds(3900)}, 0, Vector3(0, 1.2, 0), 1.0}};
  const Explanations all = explanations_of(collected_run(cell, scenario));
  const auto leaves = [](const ExplainedAt& one) {
    return contains("the tool left the picture")(one) || contains("the tool moved farther")(one);
  };
  EXPECT_GT(share_of(all, 2.3, 3.0, leaves), 0.9);
}

TEST(ExplainedRun, OfAPenThatIsTooFarNamesTheDistance) {
  Cell cell = short_cell(2);
  sim::Scenario scenario = scenario_of(cell);
  scenario.occlusions.clear();
  scenario.absences.clear();
  cell.camera.range_min_m = 0.1;
  cell.camera.range_max_m = 0.25;
  const Explanations all = explanations_of(collected_run(cell, scenario));
  EXPECT_GT(share_of(all, k_settled_s, 2, contains("range")), 0.9);
}

}  // namespace
}  // namespace glint::explained_runs_test
