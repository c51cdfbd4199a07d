#include "platform/tools/verify/holds.hpp"

#include <gtest/gtest.h>

#include "tests/unit/platform/tools/verify/made_touches.hpp"

namespace glint::holds_test {
namespace {

TEST(Holds, AreTheTouchesAndTheRest) {
  const TipSeries series = test::series_of({});
  const std::vector<StaticInterval> intervals = find_static_intervals(series);
  ASSERT_EQ(intervals.size(), 16u);
  for (std::size_t i = 0; i < 15; ++i) {
    EXPECT_GT(intervals[i].seconds, 1.2) << i;
    EXPECT_LT(intervals[i].seconds, 2.0) << i;
  }
  EXPECT_GT(intervals.back().seconds, 20);
}

// A tip at 100 mm/s is not static, nor is a tool that rotates about its tip.
TEST(Holds, NeedTipAndMarkersAtRest) {
  const TipSeries still = test::series_of({.touches = 0, .rest_s = 3});
  ASSERT_EQ(find_static_intervals(still).size(), 1u);
  TipSeries moving = still, turning = still;
  for (std::size_t i = 0; i < still.observations.size(); ++i) {
    const Vector3 way(0.1 * still.observations[i].time.nanoseconds * 1e-9, 0, 0);
    moving.observations[i].tip_m += way;
    moving.observations[i].centroid_m += way;
    turning.observations[i].centroid_m += way;
  }
  EXPECT_TRUE(find_static_intervals(moving).empty());
  EXPECT_TRUE(find_static_intervals(turning).empty());
}

// In the mean of one interval the noise falls with the root of the count; systematic errors remain.
TEST(Holds, MeanKeepsWhatSightingsHaveInCommon) {
  const TipSeries series = test::series_of({.touches = 0, .errors = {2, 0, 0}});
  const Touch touch = mean_of(series, {0, 400, 400 / 45.0});
  EXPECT_NEAR(touch.mean.random_m2.trace(), 3 * test::k_made_noise_m * test::k_made_noise_m / 400,
              1e-12);
  EXPECT_LT((touch.mean.tip_m - 2 * touch.mean.by_calibration.col(0)).norm(), 1e-4);
  EXPECT_NEAR(touch.seconds, 400 / 45.0, 1e-9);
  EXPECT_EQ(pieces_of(series, {0, 450, 450 / 45.0}, 1).size(), 10u);
}

}  // namespace
}  // namespace glint::holds_test
