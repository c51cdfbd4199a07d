// Drift correction of the headset's localisation in special cases with closed-form results.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "kernels/motion/head_drift.hpp"
#include "kernels/motion/head_drift_correction.hpp"
#include "kernels/motion/motion_filter.hpp"
#include "kernels/pose/lever_arm.hpp"
#include "tests/unit/kernels/motion/motion_scene.hpp"

namespace glint::head_closed_form_test {
namespace {

constexpr double k_frame_s = 0.02;

HeadNoise noise() {
  HeadNoise out;
  out.rest_position_m = 0.003;
  out.rest_angle_rad = 0.005;
  out.rest_correlation_s = 8;
  out.position_per_speed_s = 0.04;
  out.position_per_turn_m = 0.03;
  out.angle_per_speed_s_m = 0.05;
  out.angle_per_turn_s = 0.06;
  out.motion_correlation_s = 0.5;
  out.pivot_m = 0.4;
  return out;
}

HeadPose head_at(int frame, const Vector3& position, const Vector3& turn) {
  HeadPose head;
  head.time = Time{} + milliseconds(20) * frame;
  head.valid = true;
  head.T_world_camera = {from_rotation_vector(turn), position};
  return head;
}

Matrix6 spread(double position_m, double angle_rad) {
  Matrix6 covariance = Matrix6::Zero();
  covariance.diagonal() << Vector3::Constant(position_m * position_m),
      Vector3::Constant(angle_rad * angle_rad);
  return covariance;
}

// A head that starts to move at frame 5: its velocity is smoothed over 0.1 s, and its speed over
// the correlation time of its error.
TEST(HeadWalkForm, SmoothsVelocityThenSpeedAndAddsWhatBothDeclare) {
  const HeadNoise n = noise();
  HeadErrorProcess walk;
  const Vector3 velocity(0.3, -0.1, 0.2), turning(0.5, 0, 0);
  double moved_m_s = 0, turned_rad_s = 0, speed = 0, turn = 0;
  const double smooth = 1 - std::exp(-k_frame_s / 0.1), follow = 1 - std::exp(-k_frame_s / 0.5);
  for (int frame = 0; frame < 60; ++frame) {
    const double t = std::max(frame - 5, 0) * k_frame_s;
    const HeadPose head = head_at(frame, t * velocity, t * turning);
    const double since = walk.observe(head, n);
    if (frame == 0) continue;
    EXPECT_NEAR(since, k_frame_s, 1e-12);
    const bool moves = frame > 5;
    moved_m_s += smooth * ((moves ? velocity.norm() : 0) - moved_m_s);
    turned_rad_s += smooth * ((moves ? turning.norm() : 0) - turned_rad_s);
    speed += follow * (moved_m_s - speed);
    turn += follow * (turned_rad_s - turn);
    const Vector3 pivot = head.T_world_camera * Vector3(0, 0, n.pivot_m);
    const Matrix6 resting = spread(0.003, 0.005);
    const Matrix6 moving = spread(0.04 * speed + 0.03 * turn, 0.05 * speed + 0.06 * turn);
    const ErrorTransition walked = walk.transition_over(0.3, pivot, n);
    EXPECT_LT((walked.stationary_covariance - resting - moving).norm(), 1e-12) << frame;
    const double share = moving.trace() / (moving + resting).trace();
    EXPECT_NEAR(walked.kept, share * std::exp(-0.3 / 0.5) + (1 - share) * std::exp(-0.3 / 8),
                1e-12);
    // Beside the pivot both rotations move the point, which changes the shares of the variance.
    const Vector3 lever(0.2, -0.3, 0.1);
    const Matrix6 beside = walk.transition_over(0.3, pivot + lever, n).stationary_covariance;
    EXPECT_LT((beside - moved_covariance(resting + moving, lever)).norm(), 1e-12);
  }
  EXPECT_GT(speed, 0.3);
}

// If motion's correlation time is shorter than the jitter's, the velocity is smoothed over the
// shorter.
TEST(HeadWalkForm, SmoothsNoLongerThanTheMotionLasts) {
  HeadNoise n = noise();
  n.motion_correlation_s = 0.05;
  HeadErrorProcess walk;
  (void)walk.observe(head_at(0, {0, 0, 0}, {0, 0, 0}), n);
  (void)walk.observe(head_at(1, {0.01, 0, 0}, {0, 0, 0}), n);
  const double step = 1 - std::exp(-k_frame_s / 0.05);
  const double moving_m = 0.04 * step * step * 0.5;
  const Matrix6 found = walk.transition_over(1, {0.01, 0, n.pivot_m}, n).stationary_covariance;
  EXPECT_NEAR(found(0, 0), 0.003 * 0.003 + moving_m * moving_m, 1e-12);
  n.motion_correlation_s = 0;  // no correlation: only the newest counts
  EXPECT_NEAR(
      walk.transition_over(1, {0.01, 0, n.pivot_m}, n).kept,
      (1 - spread(moving_m, 0.05 * step * step * 0.5).trace() /
               (spread(moving_m, 0.05 * step * step * 0.5) + spread(0.003, 0.005)).trace()) *
          std::exp(-1.0 / 8),
      1e-12);
  HeadNoise none;
  none.rest_position_m = none.rest_angle_rad = 0;
  HeadErrorProcess still;
  (void)still.observe(head_at(0, {0, 0, 0}, {0, 0, 0}), none);
  EXPECT_NEAR(still.transition_over(1, {0, 0, 0}, none).kept,
              std::exp(-1 / none.rest_correlation_s), 1e-12);
  EXPECT_TRUE(still.transition_over(1, {0, 0, 0}, none).stationary_covariance.isZero());
}

TEST(HeadWalkForm, CountsNoTimeBackwards) {
  HeadErrorProcess walk;
  (void)walk.observe(head_at(9, {0, 0, 0}, {0, 0, 0}), noise());
  EXPECT_EQ(walk.observe(head_at(4, {5, 0, 0}, {0, 0, 0}), noise()), 0);
  EXPECT_NEAR(walk.transition_over(1, {5, 0, 0.4}, noise()).stationary_covariance(0, 0), 9e-6,
              1e-15)
      << "no speed";
}

UncertainPose body_at(const Vector3& position, const Vector3& turn, double shift_m,
                      double turn_rad) {
  return {Time{}, {from_rotation_vector(turn), position}, spread(shift_m, turn_rad)};
}

// Noise of a static head: terms per speed are zero.
HeadNoise resting() {
  HeadNoise out = noise();
  out.position_per_speed_s = out.position_per_turn_m = 0;
  out.angle_per_speed_s_m = out.angle_per_turn_s = 0;
  return out;
}

// The body's position is the mean of its first measurements; until then the head is not corrected.
TEST(HeadAnchorForm, DefinesTheBodyByTheMeanOfItsFirstSights) {
  HeadDriftCorrection anchor;
  test::Random random(1);
  Vector3 sum = Vector3::Zero(), turns = Vector3::Zero();
  EXPECT_FALSE(anchor.known());
  for (int sight = 0; sight < k_body_definition_frames; ++sight) {
    const Vector3 position = Vector3(0.1, 0.2, 0.6) + random.vector(0.001);
    const Vector3 turn = random.vector(0.001);
    sum += position;
    turns += turn;
    const UncertainPose body = body_at(position, turn, 0.001, 0.002);
    const CorrectedHead out = anchor.update(head_at(sight, {0, 0, 0}, {0, 0, 0}), &body, resting());
    EXPECT_TRUE(anchor.known());
    EXPECT_TRUE(out.corrected);
    EXPECT_FALSE(out.in_gap || out.moved_along);
    EXPECT_TRUE(out.independent.isZero() && out.shared.isZero() && out.step_covariance.isZero());
    EXPECT_LT((out.head.T_world_camera.translation).norm(), 1e-12);
    EXPECT_EQ(out.pivot_m, anchor.T_world_body().translation);
    EXPECT_LT((anchor.T_world_body().translation - sum / (sight + 1)).norm(), 1e-12);
    EXPECT_LT((rotation_vector(anchor.T_world_body().rotation) - turns / (sight + 1)).norm(), 3e-6);
  }
}

// The body is at the headset's pivot and its measurement covariance is diagonal, so each component
// is a scalar Kalman filter.
class CorrectedStaticHead {
 public:
  explicit CorrectedStaticHead(const HeadNoise& noise = resting()) : noise_(noise) {
    for (frame_ = 0; frame_ < k_body_definition_frames; ++frame_) {
      const UncertainPose body = body_at(k_body, {0, 0, 0}, 0.001, 0.002);
      (void)anchor.update(head_at(frame_, {0, 0, 0}, {0, 0, 0}), &body, noise_);
    }
  }
  // One frame with this error of the headset; `hidden`: without a measurement of the body.
  CorrectedHead see(const Vector3& off_m, bool hidden) {
    const HeadPose head = head_at(frame_++, off_m, {0, 0, 0});
    const UncertainPose body = body_at(k_body, {0, 0, 0}, 0.001, 0.002);
    return anchor.update(head, hidden ? nullptr : &body, noise_);
  }
  static inline const Vector3 k_body{0, 0, 0.4};
  HeadDriftCorrection anchor;

 private:
  HeadNoise noise_;
  int frame_ = 0;
};

TEST(HeadAnchorForm, CorrectsByEachSightsShareAndSplitsWhatIsLeft) {
  CorrectedStaticHead head;
  const double kept = std::exp(-k_frame_s / 8);
  double error = 0, position_variance = 0, rotation_variance = 0;
  for (int frame = 0; frame < 40; ++frame) {
    const double off = 0.0001 * frame;  // beside the pivot, which does not change x
    const CorrectedHead out = head.see({off, 0, 0}, false);
    ASSERT_EQ(head.anchor.drift_factor(), 1);
    error *= kept;
    position_variance = kept * kept * position_variance + (1 - kept * kept) * 9e-6;
    rotation_variance = kept * kept * rotation_variance + (1 - kept * kept) * 25e-6;
    const double gain = position_variance / (position_variance + 1e-6),
                 turn_gain = rotation_variance / (rotation_variance + 4e-6);
    error += gain * (off - error);
    EXPECT_TRUE(out.corrected);
    EXPECT_NEAR(out.head.T_world_camera.translation.x(), off - error, 1e-9) << frame;
    EXPECT_NEAR(out.independent(0, 0), gain * gain * 1e-6, 1e-12);
    EXPECT_NEAR(out.independent(3, 3), turn_gain * turn_gain * 4e-6, 1e-12);
    position_variance *= (1 - gain) * (1 - gain);
    rotation_variance *= (1 - turn_gain) * (1 - turn_gain);
    EXPECT_NEAR(out.shared(0, 0), position_variance, 1e-12);
    EXPECT_NEAR(out.shared(3, 3), rotation_variance, 1e-12);
    position_variance += gain * gain * 1e-6;
    rotation_variance += turn_gain * turn_gain * 4e-6;
    EXPECT_FALSE(out.in_gap);
    EXPECT_TRUE(out.step_covariance.isZero());
    EXPECT_EQ(head.anchor.jumps(), 0);
    // The correction applies to any pose of the head.
    const Pose any{from_rotation_vector({0.1, 0.2, 0.3}), {1, 2, 3}};
    EXPECT_NEAR(head.anchor.corrected(any).translation.x(), 1 - error, 1e-9);
  }
}

// Body hidden: the correction decays, its covariance grows, and each frame adds a step.
TEST(HeadAnchorForm, FadesWhileTheBodyIsHiddenAndMovesAlongWhenItIsBack) {
  CorrectedStaticHead head;
  for (int frame = 0; frame < 30; ++frame) (void)head.see({0.002, 0, 0}, false);
  const double kept = std::exp(-k_frame_s / 8);
  CorrectedHead out = head.see({0.002, 0, 0}, false);
  double error = 0.002 - out.head.T_world_camera.translation.x();
  double position_variance = out.shared(0, 0) + out.independent(0, 0);
  // About the body, which is 2 mm from the headset's pivot.
  const Matrix6 stationary_covariance = moved_covariance(spread(0.003, 0.005), {-0.002, 0, 0});
  for (int frame = 0; frame < 50; ++frame) {
    out = head.see({0.002, 0, 0}, true);
    error *= kept;
    position_variance = kept * kept * position_variance + (1 - kept * kept) * 9e-6;
    EXPECT_FALSE(out.corrected || out.moved_along);
    EXPECT_TRUE(out.in_gap);
    EXPECT_NEAR(out.head.T_world_camera.translation.x(), 0.002 - error, 1e-9);
    EXPECT_NEAR(out.shared(0, 0), position_variance, 1e-12);
    EXPECT_TRUE(out.independent.isZero());
    EXPECT_LT((out.step_covariance - (1 - kept * kept) * stationary_covariance).norm(), 1e-15);
    EXPECT_LT(
        (head.anchor.uncorrected_covariance_at(CorrectedStaticHead::k_body) - stationary_covariance)
            .norm(),
        1e-15);
  }
  const double before = error * kept;
  out = head.see({0.002, 0, 0}, false);
  EXPECT_TRUE(out.corrected && out.moved_along && out.in_gap);
  // `moved` maps poses from before the end of the gap to the new correction.
  const double after = 0.002 - out.head.T_world_camera.translation.x();
  EXPECT_NEAR(out.gap_correction.translation.x(), before - after, 1e-9);
  EXPECT_GT(std::abs(before - after), 1e-5);
  out = head.see({0.002, 0, 0}, false);
  EXPECT_FALSE(out.moved_along || out.in_gap);
}

TEST(HeadAnchorForm, MovesItsCovariancesToAPoint) {
  CorrectedHead head;
  test::Random random(2);
  head.pivot_m = {0.1, 0.2, 0.3};
  head.independent = test::random_covariance<6>(random, 0.1);
  head.shared = test::random_covariance<6>(random, 0.1);
  head.step_covariance = test::random_covariance<6>(random, 0.1);
  const Vector3 point(0.5, -0.2, 0.9), lever = point - head.pivot_m;
  EXPECT_TRUE(head.independent_at(point).isApprox(moved_covariance(head.independent, lever)));
  EXPECT_TRUE(head.shared_at(point).isApprox(moved_covariance(head.shared, lever)));
  EXPECT_TRUE(
      head.step_covariance_at(point).isApprox(moved_covariance(head.step_covariance, lever)));
  EXPECT_FALSE(head.independent_at(point).isApprox(head.independent));
}

// A head without a valid pose passes through unchanged and does not change the filter.
TEST(HeadAnchorForm, LeavesAHeadWithoutAPoseAlone) {
  CorrectedStaticHead head, same;
  HeadPose none = head_at(77, {9, 9, 9}, {1, 0, 0});
  none.valid = false;
  const UncertainPose body = body_at({3, 3, 3}, {0, 0, 0}, 0.001, 0.002);
  const CorrectedHead out = head.anchor.update(none, &body, resting());
  EXPECT_FALSE(out.corrected || out.in_gap || out.moved_along);
  EXPECT_EQ(out.head.T_world_camera.translation, Vector3(9, 9, 9));
  EXPECT_TRUE(out.shared.isZero());
  EXPECT_EQ(head.see({0.001, 0, 0}, false).head.T_world_camera.translation,
            same.see({0.001, 0, 0}, false).head.T_world_camera.translation);
}

// A measurement that fails the chi-square test is rejected. The ninth in a row is accepted and
// resets the error exactly.
TEST(HeadAnchorForm, BelievesTheBodyAfterNineRefusedSights) {
  HeadNoise precise = resting();
  precise.rest_position_m = 0.0005;
  CorrectedStaticHead head(precise);
  for (int frame = 0; frame < 20; ++frame) (void)head.see({0, 0, 0}, false);
  for (int round = 0; round < 3; ++round) {
    const double position = round % 2 == 0 ? 0.3 : -0.3;  // fails at every drift factor
    for (int refused = 1; refused <= k_body_rejected_max; ++refused) {
      const CorrectedHead out = head.see({position, 0, 0}, false);
      const bool last = refused == k_body_rejected_max;
      EXPECT_EQ(out.corrected, last) << refused;
      EXPECT_EQ(out.moved_along, last) << refused;
      EXPECT_TRUE(out.in_gap);
      EXPECT_EQ(head.anchor.jumps(), round + (last ? 1 : 0));
      if (!last) continue;
      EXPECT_NEAR(out.head.T_world_camera.translation.x(), 0, 1e-9);
      EXPECT_LT((out.independent - spread(0.001, 0.002)).norm(), 1e-15);
      EXPECT_TRUE(out.shared.isZero());
    }
    EXPECT_TRUE(head.see({position, 0, 0}, false).corrected);
  }
  // A measurement that passes the test resets the count of rejections.
  for (int refused = 0; refused < 8; ++refused)
    EXPECT_FALSE(head.see({-0.3, 0, 0}, false).corrected);
  EXPECT_TRUE(head.see({0.3, 0, 0}, false).corrected);
  for (int refused = 0; refused < 8; ++refused)
    EXPECT_FALSE(head.see({-0.3, 0, 0}, false).corrected);
  EXPECT_EQ(head.anchor.jumps(), 3);
}

}  // namespace
}  // namespace glint::head_closed_form_test
