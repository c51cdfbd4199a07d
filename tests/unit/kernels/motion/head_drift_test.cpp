#include "kernels/motion/head_drift.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/unit/kernels/motion/motion_scene.hpp"

namespace glint::head_drift_test {
namespace {

constexpr double k_frame_s = 1.0 / 45;

HeadPose head_at(double seconds, double speed_m_s, double turn_rad_s) {
  HeadPose head;
  head.time = Time{static_cast<std::int64_t>(1e9 * seconds)};
  head.valid = true;
  head.T_world_camera = {from_rotation_vector(Vector3(0, turn_rad_s * seconds, 0)),
                         Vector3(speed_m_s * seconds, 0, 0)};
  return head;
}

HeadErrorProcess moving(double speed_m_s, double turn_rad_s) {
  HeadErrorProcess walk;
  for (int frame = 0; frame < 200; ++frame)
    (void)walk.observe(head_at(frame * k_frame_s, speed_m_s, turn_rad_s), {});
  return walk;
}

// At the pivot a rotation about it causes no translation.
TEST(HeadWalk, AtRestIsAsDeclared) {
  const HeadNoise noise;
  const HeadErrorProcess walk = moving(0, 0);
  const ErrorTransition here = walk.transition_over(1, Vector3(0, 0, noise.pivot_m), noise);
  EXPECT_NEAR(here.kept, std::exp(-1 / noise.rest_correlation_s), 1e-12);
  EXPECT_NEAR(here.stationary_covariance(0, 0), noise.rest_position_m * noise.rest_position_m,
              1e-12);
  EXPECT_NEAR(here.stationary_covariance(4, 4), noise.rest_angle_rad * noise.rest_angle_rad, 1e-12);
  const ErrorTransition away = walk.transition_over(1, Vector3(0, 0, noise.pivot_m + 1), noise);
  EXPECT_NEAR(away.stationary_covariance(0, 0) - here.stationary_covariance(0, 0),
              noise.rest_angle_rad * noise.rest_angle_rad, 1e-12);
  EXPECT_TRUE(here.added().isApprox((1 - here.kept * here.kept) * here.stationary_covariance));
}

TEST(HeadWalk, InMotionIsWiderAndFaster) {
  const HeadNoise noise;
  const HeadErrorProcess walk = moving(0.4, 0);
  const Vector3 pivot(0.4 * 199 * k_frame_s, 0, noise.pivot_m);
  const ErrorTransition walked = walk.transition_over(0.1, pivot, noise);
  const double moving_m = 0.4 * noise.position_per_speed_s;
  EXPECT_NEAR(walked.stationary_covariance(1, 1),
              noise.rest_position_m * noise.rest_position_m + moving_m * moving_m, 1e-6);
  EXPECT_LT(walked.kept, std::exp(-0.1 / (2 * noise.motion_correlation_s)));
  EXPECT_GT(walked.kept, std::exp(-0.1 / noise.motion_correlation_s));
}

// The first head pose, and the first after restart_clock(), are independent of any earlier error.
TEST(HeadWalk, BeginsBeyondEveryCorrelation) {
  HeadErrorProcess walk;
  EXPECT_GT(walk.observe(head_at(5, 0, 0), {}), 1e5);
  EXPECT_NEAR(walk.observe(head_at(5.5, 0, 0), {}), 0.5, 1e-9);
  walk.restart_clock();
  EXPECT_GT(walk.observe(head_at(1, 0, 0), {}), 1e5);
}

TEST(HeadWalk, GivesTheSameBitsEverywhere) {
  test::BitHash hash;
  const ErrorTransition walked = moving(0.3, 0.5).transition_over(0.2, Vector3(0.4, -0.1, 0.7), {});
  hash.add(walked.kept);
  for (int i = 0; i < 36; ++i) hash.add(walked.stationary_covariance(i / 6, i % 6));
  EXPECT_EQ(hash.value(), 7977141867570956807u);
}

}  // namespace
}  // namespace glint::head_drift_test
