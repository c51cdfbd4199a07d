#include "kernels/pose/assign.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <initializer_list>
#include <span>
#include <vector>

#include "kernels/motion/interpolate.hpp"
#include "tests/unit/kernels/pose/scene.hpp"

namespace glint::assign_test {
namespace {

Labeling labeling_of(std::initializer_list<std::int16_t> markers, double rms_m) {
  Labeling labeling;
  labeling.marker.fill(-1);
  std::copy(markers.begin(), markers.end(), labeling.marker.begin());
  labeling.count = static_cast<int>(markers.size());
  labeling.rms_m = rms_m;
  return labeling;
}

Labelings labelings_of(std::initializer_list<Labeling> items) {
  Labelings labelings;
  for (const Labeling& item : items) {
    labelings.items[static_cast<std::size_t>(labelings.count++)] = item;
  }
  return labelings;
}

struct Outcome {
  std::vector<int> chosen;
  std::vector<Reason> reasons;
};

Outcome outcome_of(const std::vector<Labelings>& per_tool) {
  Outcome outcome{std::vector<int>(per_tool.size(), 7),
                  std::vector<Reason>(per_tool.size(), Reason::bad_fit)};
  assign_markers(per_tool, outcome.chosen, outcome.reasons);
  return outcome;
}

TEST(Assign, GivesEachToolItsBestWhereNothingIsShared) {
  const Outcome outcome = outcome_of({labelings_of({labeling_of({0, 1, 2}, 0.001)}),
                                      labelings_of({labeling_of({3, 4, 5}, 0.002)})});
  EXPECT_EQ(outcome.chosen, (std::vector<int>{0, 0}));
  EXPECT_EQ(outcome.reasons, (std::vector<Reason>{Reason::none, Reason::none}));
}

TEST(Assign, PrefersMoreMarkersToASmallerResidualAndThatToTheFirstTool) {
  const auto fewer = labelings_of({labeling_of({0, 1, 2}, 0.0001)});
  const auto more = labelings_of({labeling_of({2, 3, 4, 5}, 0.004)});
  const auto worse = labelings_of({labeling_of({0, 1, 2}, 0.003)});
  EXPECT_EQ(outcome_of({fewer, more}).chosen, (std::vector<int>{-1, 0}));
  EXPECT_EQ(outcome_of({worse, fewer}).chosen, (std::vector<int>{-1, 0}));
  EXPECT_EQ(outcome_of({fewer, fewer}).chosen, (std::vector<int>{0, -1}));
  EXPECT_EQ(outcome_of({fewer, fewer}).reasons[1], Reason::markers_assigned_elsewhere);
}

TEST(Assign, LetsTheToolThatWasPredictedThereKeepWhatNoiseAloneWouldGiveAway) {
  const auto other_tool = labelings_of({labeling_of({0, 1, 2, 3}, 0.001)});
  const auto owner = [](double rms_m) {
    Labeling labeling = labeling_of({0, 1, 2, 3}, rms_m);
    labeling.log_prior_ratio_m2 = 2e-5;
    return labelings_of({labeling});
  };
  // Sums of squares: the owner's 4 rms^2 may exceed the stranger's 4e-6 by 2e-5.
  EXPECT_EQ(outcome_of({other_tool, owner(0.0024)}).chosen, (std::vector<int>{-1, 0}));
  EXPECT_EQ(outcome_of({other_tool, owner(0.0025)}).chosen, (std::vector<int>{0, -1}));
  const auto more = labelings_of({labeling_of({0, 1, 2, 3, 4}, 0.004)});
  EXPECT_EQ(outcome_of({more, owner(0.001)}).chosen, (std::vector<int>{0, -1}));
}

TEST(Assign, TakesTheNextLabelingOfAToolWhoseMarkerIsTaken) {
  const auto first = labelings_of({labeling_of({0, 1, 2, 3, 4}, 0.001)});
  const auto second =
      labelings_of({labeling_of({4, 5, 6, 7, 8}, 0.002), labeling_of({9, 5, 6, 7}, 0.002),
                    labeling_of({5, 6, 7}, 0.001)});
  EXPECT_EQ(outcome_of({first, second}).chosen, (std::vector<int>{0, 1}));
  EXPECT_EQ(outcome_of({second, first}).chosen, (std::vector<int>{1, 0}));
}

TEST(Assign, PassesOnWhyAToolHasNoLabeling) {
  Labelings none;
  none.reason = Reason::too_few_markers;
  EXPECT_EQ(outcome_of({none}).reasons[0], Reason::too_few_markers);
  EXPECT_EQ(outcome_of({Labelings{}}).reasons[0], Reason::no_labeling);
  EXPECT_EQ(outcome_of({none}).chosen[0], -1);
}

TEST(Assign, NeverGivesAMarkerToTwoTools) {
  test::Random random(1);
  for (int trial = 0; trial < 500; ++trial) {
    std::vector<Labelings> per_tool(k_tools_max);
    for (Labelings& labelings : per_tool) {
      labelings.count = random.below(k_labelings_max + 1);
      for (Labeling& labeling : labelings.items) {
        const auto marker = static_cast<std::int16_t>(random.below(60));
        labeling = labeling_of(
            {marker, static_cast<std::int16_t>(marker + 1), static_cast<std::int16_t>(marker + 2)},
            1e-4 * random.below(10));
      }
    }
    const Outcome outcome = outcome_of(per_tool);
    std::array<int, k_blobs_max> holders{};
    for (std::size_t t = 0; t < per_tool.size(); ++t) {
      if (outcome.chosen[t] < 0) continue;
      ASSERT_LT(outcome.chosen[t], per_tool[t].count);
      const auto& chosen = per_tool[t].items[static_cast<std::size_t>(outcome.chosen[t])];
      for (const std::int16_t marker : chosen.marker) {
        if (marker < 0) continue;
        EXPECT_EQ(++holders[static_cast<std::size_t>(marker)], 1);
      }
    }
  }
}

Labeling turned(Labeling labeling, double radians) {
  labeling.T_camera_tool.rotation = from_rotation_vector(Vector3(radians, 0, 0));
  return labeling;
}

TEST(Assign, FindsTheRivalOfAsManyFreeMarkersThatPutsTheToolElsewhere) {
  const Labelings labelings = labelings_of(
      {labeling_of({0, 1, 2}, 0.001), turned(labeling_of({1, 0, 2}, 0.002), 0.05),
       turned(labeling_of({3, 0, 2}, 0.002), 1), turned(labeling_of({2, 1, 4}, 0.003), 1),
       turned(labeling_of({0, 1}, 0.001), 1)});
  MarkerOwners owners;
  owners.fill(-1);
  owners[0] = owners[1] = owners[2] = 0;
  int tests = 0;
  EXPECT_EQ(alternative_of(labelings, 0, 0, owners, Vector3::Zero(), tests), 2);
  EXPECT_LE(tests, k_labelings_max - 1);
  owners[3] = 1;
  EXPECT_EQ(alternative_of(labelings, 0, 0, owners, Vector3::Zero(), tests), 3)
      << "3 is another tool's";
  owners[4] = 1;
  EXPECT_EQ(alternative_of(labelings, 0, 0, owners, Vector3::Zero(), tests), -1)
      << "0.05 rad is the same place, two markers are not as many";
}

TEST(Assign, PrefersAsARivalTheOneThatWasForetold) {
  Labelings labelings =
      labelings_of({labeling_of({0, 1, 2}, 0.001), turned(labeling_of({1, 2, 0}, 0.002), 1),
                    turned(labeling_of({2, 0, 1}, 0.004), 2)});
  labelings.items[2].log_prior_ratio_m2 = 1e-6;
  MarkerOwners owners;
  owners.fill(-1);
  int tests = 0;
  EXPECT_EQ(alternative_of(labelings, 0, 0, owners, Vector3::Zero(), tests), 2);
}

AssignWork work_of(const std::vector<Labelings>& per_tool) {
  std::vector<int> chosen(per_tool.size());
  std::vector<Reason> reasons(per_tool.size());
  return assign_markers(per_tool, chosen, reasons);
}

// Each round tests every waiting tool once; a tool with a labeling is not tested again.
TEST(Assign, CountsEachLabelingThatItLooksAt) {
  const auto own = [](std::int16_t first) {
    const auto next = [first](int i) { return static_cast<std::int16_t>(first + i); };
    return labelings_of({labeling_of({first, next(1), next(2)}, 0.001)});
  };
  EXPECT_EQ(work_of({}).tests, 0);
  EXPECT_EQ(work_of({own(0)}).tests, 1);
  EXPECT_EQ(work_of({own(0)}).rounds, 1);
  EXPECT_EQ(work_of({own(0), own(10), own(20)}).tests, 3 + 2 + 1);
  EXPECT_EQ(work_of({own(0), own(10), own(20)}).rounds, 3);
  EXPECT_EQ(work_of({Labelings{}, own(0)}).tests, 1);
  EXPECT_EQ(work_of({Labelings{}, own(0)}).rounds, 1);
  EXPECT_EQ(work_of({own(0), own(0)}).tests, 2 + 1) << "the second one's is taken";
  EXPECT_EQ(work_of({own(0), own(0)}).rounds, 1);
}

// All but the last labeling of each tool contain the marker that is taken first.
TEST(Assign, LooksAtNoMoreThanItsWorst) {
  for (const int tools : {1, 2, 5, k_tools_max}) {
    std::vector<Labelings> per_tool(static_cast<std::size_t>(tools));
    for (std::size_t t = 0; t < per_tool.size(); ++t) {
      per_tool[t].count = k_labelings_max;
      const auto own = static_cast<std::int16_t>(10 + 3 * t);
      for (Labeling& labeling : per_tool[t].items) labeling = labeling_of({0, 1, own}, 0.001);
      per_tool[t].items[k_labelings_max - 1] = labeling_of(
          {own, static_cast<std::int16_t>(own + 1), static_cast<std::int16_t>(own + 2)}, 0.001);
    }
    const int rivals = tools * (k_labelings_max - 1);
    EXPECT_EQ(work_of(per_tool).tests, assign_tests_worst(tools) - rivals) << tools;
    EXPECT_EQ(work_of(per_tool).rounds, tools);
  }
}

TEST(Assign, TakesAsManyToolsAsTheShortestSpanHas) {
  const auto own = labelings_of({labeling_of({0, 1, 2}, 0.001)});
  const std::vector<Labelings> per_tool(k_tools_max + 2, own);
  std::vector<int> chosen(k_tools_max + 2, 7);
  std::vector<Reason> reasons(k_tools_max + 2, Reason::bad_fit);
  assign_markers(per_tool, chosen, reasons);
  EXPECT_EQ(chosen[0], 0);
  EXPECT_EQ(chosen[k_tools_max - 1], -1);
  EXPECT_EQ(reasons[k_tools_max - 1], Reason::markers_assigned_elsewhere);
  EXPECT_EQ(chosen[k_tools_max], 7) << "more than there may be";
  for (const std::size_t size : {0U, 1U, 3U}) {
    std::fill(chosen.begin(), chosen.end(), 7);
    assign_markers(per_tool, std::span(chosen).first(size), reasons);
    EXPECT_EQ(std::count(chosen.begin(), chosen.end(), 7), k_tools_max + 2 - std::ptrdiff_t(size));
    std::fill(chosen.begin(), chosen.end(), 7);
    assign_markers(per_tool, chosen, std::span(reasons).first(size));
    EXPECT_EQ(std::count(chosen.begin(), chosen.end(), 7), k_tools_max + 2 - std::ptrdiff_t(size));
    std::fill(chosen.begin(), chosen.end(), 7);
    assign_markers(std::span(per_tool).first(size), chosen, reasons);
    EXPECT_EQ(std::count(chosen.begin(), chosen.end(), 7), k_tools_max + 2 - std::ptrdiff_t(size));
  }
}

TEST(Assign, ReadsNoMoreLabelingsThanAreKept) {
  Labelings labelings;
  for (Labeling& labeling : labelings.items) labeling = labeling_of({0, 1, 2}, 0.001);
  labelings.count = k_labelings_max + 5;
  const auto first = labelings_of({labeling_of({0, 1, 2, 3}, 0.001)});
  EXPECT_EQ(outcome_of({first, labelings}).chosen, (std::vector<int>{0, -1}));
  EXPECT_EQ(work_of({first, labelings}).tests, 2 + k_labelings_max);
}

// The sum of squares is over all markers: a small rms difference counts more with more markers.
TEST(Assign, ComparesTheSumOfSquaresLessAPredictionsWorth) {
  Labeling without_prior = labeling_of({0, 1, 2, 3}, 0.002),
           with_prior = labeling_of({0, 1, 2, 3}, 0.003);
  // 4 x 4e-6 and 4 x 9e-6: a difference of 2e-5.
  for (const double worth_m2 : {1.9e-5, 2.1e-5}) {
    with_prior.log_prior_ratio_m2 = worth_m2;
    const bool second = worth_m2 > 2e-5;
    EXPECT_EQ(outcome_of({labelings_of({without_prior}), labelings_of({with_prior})}).chosen,
              second ? (std::vector<int>{-1, 0}) : (std::vector<int>{0, -1}));
    EXPECT_EQ(outcome_of({labelings_of({with_prior}), labelings_of({without_prior})}).chosen,
              second ? (std::vector<int>{0, -1}) : (std::vector<int>{-1, 0}));
  }
}

// alternative_of() skips labelings with another number of markers, the chosen one and, once it has
// a rival, those that were not predicted.
TEST(Assign, CountsTheRivalsThatItLooksAt) {
  Labelings labelings = labelings_of(
      {labeling_of({0, 1, 2}, 0.001), labeling_of({0, 1}, 0.001),
       turned(labeling_of({1, 0, 2}, 0.002), 0.01), turned(labeling_of({1, 2, 0}, 0.002), 1),
       turned(labeling_of({2, 1, 0}, 0.002), 1.5), turned(labeling_of({2, 0, 1}, 0.004), 2)});
  MarkerOwners owners;
  owners.fill(-1);
  int tests = 100;
  EXPECT_EQ(alternative_of(labelings, 0, 0, owners, Vector3::Zero(), tests), 3);
  EXPECT_EQ(tests, 100 + 2);
  labelings.items[5].log_prior_ratio_m2 = 1e-6;
  tests = 0;
  EXPECT_EQ(alternative_of(labelings, 0, 0, owners, Vector3::Zero(), tests), 5);
  EXPECT_EQ(tests, 3);
  labelings.items[3].log_prior_ratio_m2 = 1e-6;
  tests = 0;
  EXPECT_EQ(alternative_of(labelings, 0, 0, owners, Vector3::Zero(), tests), 3)
      << "predicted, and first";
  EXPECT_EQ(tests, 2);
  EXPECT_EQ(alternative_of(labelings, 5, 0, owners, Vector3::Zero(), tests), 3);
  labelings.count = 3;
  EXPECT_EQ(alternative_of(labelings, 0, 0, owners, Vector3::Zero(), tests), -1);
}

}  // namespace
}  // namespace glint::assign_test
