#include <gtest/gtest.h>

#include <cmath>

#include "kernels/motion/interpolate.hpp"
#include "platform/sim/hand_motion.hpp"
#include "platform/sim/placed_motion.hpp"
#include "platform/sim/tool_body.hpp"
#include "small_scene.hpp"

namespace glint::sim {
namespace {

Time at_ms(int ms) { return Time{ms * 1'000'000LL}; }

TEST(HandMotion, TremblesByItsDeclaredAmountAtRest) {
  HandSettings settings;
  settings.rest_fraction = 1;
  const MotionPointer hand = hand_motion(settings, 1, 0);
  double squares = 0;
  constexpr int n = 4000;
  for (int i = 0; i < n; ++i) squares += hand->pose(at_ms(5 * i)).translation.squaredNorm();
  EXPECT_NEAR(std::sqrt(squares / (3 * n)), settings.tremor_rms_m, 0.05 * settings.tremor_rms_m);
}

TEST(HandMotion, RestsBeforeItsBeginAndThenDraws) {
  HandSettings settings;
  settings.begin_s = 3;
  settings.rest_fraction = 0;
  const MotionPointer hand = hand_motion(settings, 1, 0);
  double most = 0;
  for (int ms = 0; ms < 3000; ms += 10) {
    EXPECT_LT(hand->pose(at_ms(ms)).translation.norm(), 0.001);
  }
  for (int ms = 4000; ms < 14000; ms += 10) {
    most = std::max(most, hand->pose(at_ms(ms)).translation.norm());
  }
  EXPECT_GT(most, 0.05);
  EXPECT_LT(most, 0.3);
}

TEST(HandMotion, MovesNoFasterThanAHand) {
  HandSettings settings;
  const MotionPointer hand = hand_motion(settings, 1, 0);
  for (int ms = 0; ms < 60000; ms += 10) {
    const TimedPose a{at_ms(ms), hand->pose(at_ms(ms))};
    const TimedPose b{at_ms(ms + 10), hand->pose(at_ms(ms + 10))};
    const Velocity velocity = velocity_between(a, b);
    ASSERT_LT(velocity.linear_m_s.norm(), 1.5) << ms;
    ASSERT_LT(velocity.angular_rad_s.norm(), 6.0) << ms;
  }
}

TEST(HandMotion, TurnsAboutTheGrip) {
  HandSettings settings;
  settings.stroke_rms_m = settings.tremor_rms_m = 0;
  settings.grip_m = Vector3(0.1, 0.2, 0.3);
  settings.T_world_tool.translation = Vector3(1, 2, 3);
  const MotionPointer hand = hand_motion(settings, 1, 0);
  double turned = 0;
  for (int ms = 0; ms < 12000; ms += 100) {
    const Pose pose = hand->pose(at_ms(ms));
    EXPECT_NEAR((pose * settings.grip_m - Vector3(1.1, 2.2, 3.3)).norm(), 0, 1e-12);
    turned = std::max(turned, rotation_vector(pose.rotation).norm());
  }
  EXPECT_GT(turned, 0.2);
}

TEST(HeadMotion, LooksAtItsTargetWithALevelHorizon) {
  const Pose camera = look_at(Vector3(0.1, 0.2, 0.3), Vector3(0.6, 0.1, 0));
  const Vector3 target = camera.inverse() * Vector3(0.6, 0.1, 0);
  EXPECT_NEAR(target.x(), 0, 1e-12);
  EXPECT_NEAR(target.y(), 0, 1e-12);
  EXPECT_GT(target.z(), 0);
  EXPECT_NEAR((camera.rotation * Vector3::UnitX()).z(), 0, 1e-12);
  EXPECT_LT((camera.rotation * Vector3::UnitY()).z(), 0);
}

TEST(Grip, HoldsTheToolWithItsBestSideToTheCameraAndItsTipBelow) {
  Tool tool = five_spheres();
  tool.tip_m = Vector3(0, -0.2, 0);
  const Grip grip = best_grip(tool);
  EXPECT_GT(std::abs(grip.towards_camera.z()), 0.8);  // the markers are near the x-y plane
  const Vector3 place(0.45, 0.1, -0.2);
  const Pose pose = grip_pose(grip, place, Vector3::Zero());
  EXPECT_NEAR((pose * grip.centroid - place).norm(), 0, 1e-12);
  EXPECT_NEAR((pose.rotation * grip.towards_camera).dot(place.normalized()), -1, 1e-9);
  EXPECT_LT((pose * tool.tip_m).z(), place.z() - 0.1);
}

TEST(AttachedMotion, CarriesTheChildAlong) {
  const Pose parent{from_rotation_vector({0, 0, 1.5707963267948966}), Vector3(1, 0, 0)};
  const MotionPointer motion = attached_motion(
      fixed_motion(parent), fixed_motion({Quaternion::Identity(), Vector3(2, 0, 0)}));
  EXPECT_NEAR((motion->pose(Time{}).translation - Vector3(1, 2, 0)).norm(), 0, 1e-12);
}

TEST(PlacedMotion, IsScaledAboutItsMiddleAndPutAtTheAnchor) {
  Trajectory path;  // a parabola
  for (int i = 0; i <= 10; ++i) {
    const double t = 0.05 * i;
    path.samples.push_back(
        {at_ms(50 * i), {from_rotation_vector({0, 0, t}), Vector3(t, t * t, 1)}});
  }
  const Pose anchor{Quaternion::Identity(), Vector3(5, 6, 7)};
  const MotionPointer whole = placed_motion(path, {anchor, 1, 0});
  const MotionPointer half = placed_motion(path, {anchor, 0.5, 0});
  const Vector3 from_middle = whole->pose(Time{}).translation - anchor.translation;
  EXPECT_NEAR(from_middle.norm(), Vector3(0.25, 0.125, 0).norm(), 1e-9);
  EXPECT_NEAR((half->pose(Time{}).translation - anchor.translation - 0.5 * from_middle).norm(), 0,
              1e-12);
  EXPECT_NEAR(rotation_vector(whole->pose(Time{}).rotation).norm(), 0, 1e-12);
  EXPECT_NEAR(scale_to_half_extent(path, 0.1), 0.4, 1e-12);
}

}  // namespace
}  // namespace glint::sim
