// Sensitivity analysis: which bounds the factor scales, and the search for the largest factor.
#include "schedules/sensitivity.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "random_groups.hpp"

namespace glint::sensitivity_test {
namespace {

TaskModel two_groups() {
  TaskModel model;
  model.cores = 3;
  model.groups = {staged_group({{"A", 1, 3}, {"B", 1, 5}}), staged_group({{"C", 1, 7}})};
  model.groups[0].longest_slice_ns = 11;
  model.groups[1].longest_slice_ns = 13;
  model.system = {101, 103, 107, 109, 113};
  return model;
}

TEST(Scaled, RoundsUpTheBoundsOfTheChosenNodesAlone) {
  const TaskModel scaled_model =
      scaled(two_groups(), 1.5, [](std::size_t g, std::size_t n) { return g == 0 && n == 1; });
  EXPECT_EQ(scaled_model.cores, 3);
  EXPECT_EQ(scaled_model.groups[0].nodes[0].bound_ns, 3);
  EXPECT_EQ(scaled_model.groups[0].nodes[1].bound_ns, 8);  // 7.5
  EXPECT_EQ(scaled_model.groups[1].nodes[0].bound_ns, 7);
  EXPECT_EQ(scaled_model.groups[0].longest_slice_ns, 17);  // 16.5
  EXPECT_EQ(scaled_model.groups[1].longest_slice_ns, 13) << "none of its nodes grows";
}

TEST(Scaled, GrowsTheSystemsTimesOnlyWhereAskedAndNeverItsRate) {
  const auto none = [](std::size_t, std::size_t) { return false; };
  const SystemShare same = scaled(two_groups(), 1.5, none).system;
  EXPECT_EQ(same.wake_up_ns, 101);
  EXPECT_EQ(same.interrupt_ns, 103);
  EXPECT_EQ(same.interrupt_gap_ns, 107);
  EXPECT_EQ(same.can_write_ns, 109);
  EXPECT_EQ(same.inter_core_delay_ns, 113);
  const SystemShare grown = scaled(two_groups(), 1.5, none, true).system;
  EXPECT_EQ(grown.wake_up_ns, 152);
  EXPECT_EQ(grown.interrupt_ns, 155);
  EXPECT_EQ(grown.interrupt_gap_ns, 107);
  EXPECT_EQ(grown.can_write_ns, 164);
  EXPECT_EQ(grown.inter_core_delay_ns, 170);
}

TEST(Scaled, ByOneChangesNothing) {
  const auto all = [](std::size_t, std::size_t) { return true; };
  const TaskModel same = scaled(two_groups(), 1, all, true);
  EXPECT_EQ(same.groups[0].nodes[1].bound_ns, 5);
  EXPECT_EQ(same.groups[0].longest_slice_ns, 11);
  EXPECT_EQ(same.system.wake_up_ns, 101);
}

// For a predicate true up to a limit: just below the limit, after few evaluations.
TEST(LargestFactor, IsTheLimitWithinATenThousandthAndHolds) {
  for (const double limit : {0.003, 0.25, 0.999, 1.0, 1.001, 1.38, 17.0, 400.0, 999.0}) {
    int asked = 0;
    const auto found = largest_factor([&](double factor) {
      ++asked;
      return factor <= limit;
    });
    ASSERT_TRUE(found) << limit;
    EXPECT_LE(*found, limit);
    EXPECT_GE(*found, limit - 1.01e-4 * (limit + 1e-3)) << limit;
    EXPECT_LE(asked, k_bisection_steps + 2);
  }
}

TEST(LargestFactor, IsTheLargestAskedForWhereEverythingHolds) {
  int asked = 0;
  EXPECT_EQ(largest_factor([&](double) { return ++asked > 0; }), k_factor_max);
  EXPECT_EQ(asked, 1);
}

TEST(LargestFactor, IsNoneWhereEvenWorkThatTakesNoTimeIsLate) {
  EXPECT_FALSE(largest_factor([](double) { return false; }));
  EXPECT_EQ(largest_factor([](double factor) { return factor == 0; }).value_or(-1), 0);
}

TEST(SlackPercent, IsTheFactorsDistanceFromOne) {
  EXPECT_DOUBLE_EQ(slack_percent(1.38), 38);
  EXPECT_DOUBLE_EQ(slack_percent(0.8), -20);
}

}  // namespace
}  // namespace glint::sensitivity_test
