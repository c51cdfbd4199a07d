#include "platform/sim/touches.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "platform/sim/scenarios.hpp"

namespace glint::sim::touches_test {
namespace {

Scenario touches(std::uint64_t seed) {
  Scenario scenario = still_run(hololens2_ahat(), {});
  touch_points({}, seed, scenario);
  return scenario;
}

Time touch_centre_time(int touch) {
  const TouchSettings settings;
  return {static_cast<std::int64_t>(
      1e9 * (touch * (settings.hold_s + settings.move_s) + 0.5 * settings.hold_s))};
}

// Two touches of the first point, one of the second, and so on; at the end a static window.
TEST(Touches, StandOnTheirPoints) {
  const Scenario scenario = touches(1);
  const TouchSettings settings;
  const Vector3& tip_m = scenario.tools[0].tool.tip_m;
  for (int i = 0; i <= settings.touches; ++i) {
    const bool second = i % 3 == 2 && i < settings.touches;
    const Vector3 tip = scenario.tools[0].motion->pose(touch_centre_time(i)) * tip_m;
    EXPECT_LT((tip - (second ? settings.second_m : settings.first_m)).norm(), 0.0003) << i;
  }
  const Time before_end = Time{} + settings.duration() - milliseconds(10);
  EXPECT_LT((scenario.tools[0].motion->pose(before_end) * tip_m - settings.first_m).norm(), 0.0003);
  EXPECT_EQ(scenario.duration.nanoseconds, settings.duration().nanoseconds);
}

TEST(Touches, LeanAndAreSeenFromOtherPlaces) {
  const Scenario scenario = touches(2);
  double turn = 0, way_m = 0, near_m = 1, far_m = 0;
  for (int i = 0; i < TouchSettings{}.touches; ++i) {
    const Pose tool = scenario.tools[0].motion->pose(touch_centre_time(i));
    const Pose next = scenario.tools[0].motion->pose(touch_centre_time(i + 1));
    const Pose head = scenario.head->pose(touch_centre_time(i));
    turn = std::max(turn, tool.rotation.angularDistance(next.rotation));
    way_m = std::max(
        way_m,
        (head.translation - scenario.head->pose(touch_centre_time(i + 1)).translation).norm());
    const double range_m = (head.inverse() * tool.translation).norm();
    near_m = std::min(near_m, range_m);
    far_m = std::max(far_m, range_m);
  }
  EXPECT_GT(turn, 0.5);
  EXPECT_GT(way_m, 0.2);
  EXPECT_GT(far_m - near_m, 0.2);
  EXPECT_NE(touches(3).head->pose({}).translation, scenario.head->pose({}).translation);
}

// The tip moves by less than 2 cm between two frames.
TEST(Touches, MoveSmoothly) {
  const Scenario scenario = touches(1);
  const Vector3& tip_m = scenario.tools[0].tool.tip_m;
  Vector3 last = scenario.tools[0].motion->pose({}) * tip_m;
  for (Time t; t < Time{} + scenario.duration; t = t + milliseconds(22)) {
    const Vector3 tip = scenario.tools[0].motion->pose(t) * tip_m;
    EXPECT_LT((tip - last).norm(), 0.02);
    last = tip;
  }
}

}  // namespace
}  // namespace glint::sim::touches_test
