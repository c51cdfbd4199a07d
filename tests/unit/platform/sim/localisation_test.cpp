#include "platform/sim/localisation.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "kernels/motion/interpolate.hpp"
#include "platform/sim/hand_motion.hpp"

namespace glint::sim {
namespace {

constexpr Duration k_long = milliseconds(400'000);

LocalisationSettings still_settings() {
  LocalisationSettings settings;
  settings.rest_position_m = 0.002;
  settings.rest_angle_rad = 0.004;
  settings.rest_correlation_s = 2;
  return settings;
}

// A point on the camera's optical axis: rotation errors do not move it.
Vector3 pivot_of(const Pose& camera, double pivot_m) { return camera * Vector3(0, 0, pivot_m); }

struct Spread {
  double position = 0, angle = 0, kurtosis = 0;  // each axis
};

Spread spread_of(const LocalisationSettings& settings, const MotionPointer& camera) {
  const Localisation localisation(settings, camera, k_long, 3);
  double position2 = 0, position4 = 0, angle2 = 0;
  int n = 0;
  for (std::int64_t ms = 0; ms < 400'000; ms += 50) {
    const Time t{ms * 1'000'000};
    const Pose truth = camera->pose(t), estimated = localisation.pose(t);
    const Vector3 move = pivot_of(estimated, settings.pivot_m) - pivot_of(truth, settings.pivot_m);
    const Vector3 turn = rotation_vector(estimated.rotation * truth.rotation.conjugate());
    for (int axis = 0; axis < 3; ++axis) {
      position2 += move[axis] * move[axis];
      position4 += move[axis] * move[axis] * move[axis] * move[axis];
      angle2 += turn[axis] * turn[axis];
      ++n;
    }
  }
  return {std::sqrt(position2 / n), std::sqrt(angle2 / n),
          (position4 / n) / ((position2 / n) * (position2 / n))};
}

MotionPointer swaying(double amount) {
  HeadSettings head;
  head.sway_rms_m = 0.1 * amount;
  head.gaze_rms_rad = 0.2 * amount;
  return head_motion(head, 1);
}

TEST(Localisation, DriftsAtRestByItsDeclaredAmount) {
  const LocalisationSettings settings = still_settings();
  const Spread spread = spread_of(settings, fixed_motion(Pose{}));
  EXPECT_NEAR(spread.position, settings.rest_position_m, 0.15 * settings.rest_position_m);
  EXPECT_NEAR(spread.angle, settings.rest_angle_rad, 0.15 * settings.rest_angle_rad);
  EXPECT_NEAR(spread.kurtosis, 3, 0.5);
}

TEST(Localisation, WandersSlowlyAtRest) {
  const LocalisationSettings settings = still_settings();
  const Localisation localisation(settings, fixed_motion(Pose{}), k_long, 3);
  for (int i = 0; i < 1000; ++i) {
    const Vector3 a = localisation.pose(Time{i * 33'000'000LL}).translation;
    const Vector3 b = localisation.pose(Time{i * 33'000'000LL + 5'000'000}).translation;
    EXPECT_LT((a - b).norm(), 0.35 * settings.rest_position_m);
  }
}

TEST(Localisation, ErrsMoreTheFasterItMovesAndWithHeavierTails) {
  LocalisationSettings settings = still_settings();
  settings.rest_position_m = settings.rest_angle_rad = 0;
  settings.position_per_speed_s = 0.1;
  settings.angle_per_speed_s_m = 0.2;
  const Spread still = spread_of(settings, fixed_motion(Pose{}));
  const Spread slow = spread_of(settings, swaying(0.5));
  const Spread fast = spread_of(settings, swaying(1));
  EXPECT_LT(still.position, 1e-12);
  EXPECT_GT(slow.position, 0.001);
  EXPECT_NEAR(fast.position / slow.position, 2, 0.1);
  EXPECT_NEAR(fast.angle / slow.angle, 2, 0.1);
  EXPECT_GT(fast.kurtosis, 3.3);
}

TEST(Localisation, GivesThePoseOfAMomentAgo) {
  LocalisationSettings settings;
  settings.rest_position_m = settings.rest_angle_rad = 0;
  settings.position_per_speed_s = settings.position_per_angular_speed_m = 0;
  settings.angle_per_speed_s_m = settings.angle_per_angular_speed_s = 0;
  settings.latency_s = 0.02;
  const MotionPointer camera = swaying(1);
  const Localisation localisation(settings, camera, k_long, 3);
  const Time now{5'000'000'000}, before{4'980'000'000};
  EXPECT_NEAR((localisation.pose(now).translation - camera->pose(before).translation).norm(), 0,
              1e-12);
  EXPECT_GT((camera->pose(now).translation - camera->pose(before).translation).norm(), 1e-4);
}

TEST(Localisation, KeepsThePivotWhereOnlyTheAngleErrs) {
  LocalisationSettings settings = still_settings();
  settings.rest_position_m = 0;
  settings.rest_angle_rad = 0.05;
  settings.pivot_m = 0.7;
  const Localisation localisation(settings, fixed_motion(Pose{}), k_long, 3);
  double moved = 0;
  for (int i = 0; i < 100; ++i) {
    const Pose pose = localisation.pose(Time{i * 100'000'000LL});
    EXPECT_NEAR((pivot_of(pose, 0.7) - Vector3(0, 0, 0.7)).norm(), 0, 0.01);
    moved = std::max(moved, pose.translation.norm());
  }
  EXPECT_GT(moved, 0.02);
}

TEST(Reference, IsSubMillimetreInItsOwnAxes) {
  ReferenceSettings settings;
  settings.T_reference_world = {from_rotation_vector({0.1, 0.2, 0.3}), Vector3(1, 2, 3)};
  const Pose tool{from_rotation_vector({0.5, 0, 0}), Vector3(0.4, 0, -0.2)};
  const Pose expected = settings.T_reference_world * tool;
  double squares = 0, turns = 0;
  constexpr int n = 3000;
  for (std::uint64_t i = 0; i < n; ++i) {
    const Pose seen = reference_pose(settings, tool, 1, 0, i);
    squares += (seen.translation - expected.translation).squaredNorm();
    turns += rotation_vector(seen.rotation * expected.rotation.conjugate()).squaredNorm();
  }
  EXPECT_NEAR(std::sqrt(squares / (3 * n)), settings.position_sigma_m, 1e-5);
  EXPECT_NEAR(std::sqrt(turns / (3 * n)), settings.angle_sigma_rad, 2e-5);
}

}  // namespace
}  // namespace glint::sim
