#include "kernels/motion/occlusion_noise.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace glint {
namespace {

TEST(Strokes, SpreadAlongTheMotionAlone) {
  const Vector3 velocity(0.3, 0.4, 0);
  const Matrix3 spread = occlusion_covariance(velocity, 2, 0.2);
  EXPECT_NEAR(velocity.dot(spread * velocity) / velocity.squaredNorm(), 0.0016 * 0.25, 1e-15);
  EXPECT_NEAR((spread * Vector3(0.4, -0.3, 0)).norm(), 0, 1e-15);
  EXPECT_EQ(occlusion_covariance(Vector3::Zero(), 2, 0.2), Matrix3(Matrix3::Zero()));
}

// Slow: the share measured on recorded hands. Fast: the deceleration that stops a hand within its
// reach.
TEST(Strokes, EndWithinAHandsReach) {
  EXPECT_NEAR(linear_occlusion_share_1_s(Vector3(0, 0.05, 0)), k_linear_occlusion_share_1_s, 0.003);
  const Vector3 fast(2.7, 0, 0);
  const double stopping_m_s2 = 2.7 * 2.7 / (2 * k_hand_reach_m);
  EXPECT_NEAR(linear_occlusion_share_1_s(fast) * 2.7, std::hypot(stopping_m_s2, 0.9 * 2.7), 1e-12);
}

// The test propagates between the steps: rotation by angular velocity.
TEST(Strokes, OfSingleStepsAddUpToTheWholesSpeed) {
  const Vector3 velocity(0, 0, 1.5);
  const int steps = 90;
  const double seconds = 0.9 / steps;
  MotionCovariance sum = MotionCovariance::Zero();
  MotionCovariance carry = MotionCovariance::Identity();
  carry.block<3, 3>(k_rotation, k_angular_velocity) = seconds * Matrix3::Identity();
  for (int step = 1; step <= steps; ++step) {
    sum = (carry * sum * carry.transpose()).eval();
    add_occlusion_noise(sum, k_rotation, velocity, 0.5, step * seconds, seconds);
  }
  const double speed = 0.5 * 0.9 * 1.5;
  EXPECT_NEAR(sum(k_angular_velocity + 2, k_angular_velocity + 2), speed * speed, 1e-12);
  const double one_step_variance = occlusion_covariance(velocity, 0.5, 0.9)(2, 2);
  EXPECT_NEAR(sum(k_rotation + 2, k_rotation + 2), 2 * one_step_variance / 3,
              1e-3 * one_step_variance);
  sum.block<6, 6>(k_rotation, k_rotation).setZero();
  EXPECT_NEAR(sum.norm(), 0, 1e-12);  // the other blocks are unchanged
}

}  // namespace
}  // namespace glint
