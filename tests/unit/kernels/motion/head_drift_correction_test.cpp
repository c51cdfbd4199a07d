#include "kernels/motion/head_drift_correction.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "kernels/motion/cholesky.hpp"
#include "kernels/motion/motion_filter.hpp"
#include "tests/unit/kernels/motion/motion_scene.hpp"
#include "tests/unit/repetitions.hpp"

namespace glint {
namespace {

constexpr double k_frame_s = 1.0 / 45;
constexpr double k_body_shift_sigma = 0.0003, k_body_rotation_sigma_rad = 0.004;

// A headset in front of a body; its localisation error follows the declared process about a pivot
// ahead of the camera.
class Headset {
 public:
  Headset(const HeadNoise& noise, std::uint64_t random_seed) : noise_(noise), random_(random_seed) {
    body_ = {random_.rotation(), Vector3(0.1, 0.05, 0.6)};
    translation_error_m_ = noise_.rest_position_m * random_.vector(1);
    rotation_error_rad_ = noise_.rest_angle_rad * random_.vector(1);
  }
  void step() {
    ++frame_;
    const double kept = std::exp(-k_frame_s / noise_.rest_correlation_s);
    const double renewed = std::sqrt(1 - kept * kept);
    translation_error_m_ =
        kept * translation_error_m_ + renewed * noise_.rest_position_m * random_.vector(1);
    rotation_error_rad_ =
        kept * rotation_error_rad_ + renewed * noise_.rest_angle_rad * random_.vector(1);
  }
  [[nodiscard]] HeadPose given() const {
    const Quaternion turn = from_rotation_vector(rotation_error_rad_);
    const Vector3 pivot(0, 0, noise_.pivot_m);
    HeadPose head;
    head.time = Time{} + milliseconds(22) * frame_;
    head.valid = true;
    head.T_world_camera = {turn, pivot + translation_error_m_ + jump_ - turn * pivot};
    return head;
  }
  [[nodiscard]] UncertainPose body() {
    return test::measured_pose(body_, {}, k_body_shift_sigma, k_body_rotation_sigma_rad, random_);
  }
  void jump(const Vector3& by) { jump_ += by; }
  [[nodiscard]] const Pose& body_truth() const { return body_; }

 private:
  HeadNoise noise_;
  test::Random random_;
  Pose body_;  // the camera is at the world's origin
  Vector3 translation_error_m_, rotation_error_rad_, jump_ = Vector3::Zero();
  int frame_ = 0;
};

// Displacement since the start of an exactly measured point that the corrected head maps to the
// world.
TEST(HeadAnchor, KeepsTheWorldToTheBodyWhereTheHeadsetWanders) {
  HeadNoise noise;
  noise.rest_position_m = 0.004;
  noise.rest_angle_rad = 0.01;
  noise.rest_correlation_s = 2;
  double free = 0, held = 0;
  int count = 0;
  for (std::uint64_t random_seed = 1; random_seed <= 20; ++random_seed) {
    Headset headset(noise, random_seed);
    HeadDriftCorrection anchor;
    const Vector3 point(0.05, 0, 0.55);
    Vector3 free_first = Vector3::Zero(), held_first = Vector3::Zero();
    for (int frame = 0; frame < 400; ++frame) {
      headset.step();
      const UncertainPose body = headset.body();
      const CorrectedHead out = anchor.update(headset.given(), &body, noise);
      const Vector3 by_head = headset.given().T_world_camera * point;
      const Vector3 by_body = out.head.T_world_camera * point;
      if (frame == 90) free_first = by_head, held_first = by_body;
      if (frame < 90) continue;
      free += (by_head - free_first).squaredNorm();
      held += (by_body - held_first).squaredNorm();
      ++count;
    }
  }
  EXPECT_GT(std::sqrt(free / count), 0.005);
  EXPECT_LT(std::sqrt(held / count), 0.0012);
}

// NEES of the corrected world, with the body visible and half a second after it was hidden.
TEST(HeadAnchor, KnowsHowSureItIs) {
  const HeadNoise noise;
  double seen = 0, hidden = 0;
  const int runs = 300;
  for (int run = 0; run < runs; ++run) {
    Headset headset(noise, 100 + static_cast<std::uint64_t>(run));
    HeadDriftCorrection anchor;
    const auto nees = [&](const CorrectedHead& out) {
      // The true body pose, mapped to the world by the corrected head, against the pose at
      // definition.
      const Pose placed = out.head.T_world_camera * headset.body_truth();
      const Vector6 error = pose_difference(placed, anchor.T_world_body());
      const Matrix6 covariance = out.independent + out.shared;
      return Cholesky<6>(covariance).squared_length(error);
    };
    CorrectedHead out;
    for (int frame = 0; frame < 225; ++frame) {
      headset.step();
      const UncertainPose body = headset.body();
      out = anchor.update(headset.given(), &body, noise);
    }
    seen += nees(out) / runs;
    for (int frame = 0; frame < 22; ++frame) {
      headset.step();
      out = anchor.update(headset.given(), nullptr, noise);
    }
    hidden += nees(out) / runs;
  }
  // The error of the first second of measurements moves the whole world and is in no covariance.
  EXPECT_GT(seen / 6, 0.7);
  EXPECT_LT(seen / 6, 1.9);
  EXPECT_GT(hidden / 6, 0.7);
  EXPECT_LT(hidden / 6, 1.7);
}

// The headset's error is 20 times the declared one, then as declared.
TEST(HeadAnchor, HoldsTheWorldOfAHeadsetThatDriftsMoreThanDeclared) {
  const HeadNoise declared;
  HeadNoise wide = declared;
  wide.rest_position_m *= 20;
  wide.rest_angle_rad *= 20;
  const auto headsets = static_cast<std::uint64_t>(test::repetitions(20, 6));
  for (const bool drifts : {true, false}) {
    double errors = 0, nees = 0;
    int count = 0;
    for (std::uint64_t random_seed = 1; random_seed <= headsets; ++random_seed) {
      Headset headset(drifts ? wide : declared, random_seed);
      HeadDriftCorrection anchor;
      for (int frame = 0; frame < 400; ++frame) {
        headset.step();
        const UncertainPose body = headset.body();
        const CorrectedHead out = anchor.update(headset.given(), &body, declared);
        if (frame < 200) continue;
        const Pose placed = out.head.T_world_camera * headset.body_truth();
        const Vector6 error = pose_difference(placed, anchor.T_world_body());
        errors += error.head<3>().squaredNorm();
        nees += Cholesky<6>(Matrix6(out.independent + out.shared)).squared_length(error) / 6;
        ++count;
      }
      // The error's jitter also raises the estimated speed, and with it the declared error.
      EXPECT_EQ(anchor.drift_factor() > 1, drifts) << random_seed;
    }
    EXPECT_LT(std::sqrt(errors / count), 0.0012) << drifts;
    EXPECT_GT(nees / count, 0.5) << drifts;
    EXPECT_LT(nees / count, 2) << drifts;
  }
}

TEST(HeadAnchor, WithoutABodySaysWhatTheHeadsetDeclares) {
  HeadNoise noise;
  HeadDriftCorrection anchor;
  HeadPose head;
  head.valid = true;
  head.T_world_camera.translation = {0.3, 0.2, 0.1};
  const CorrectedHead out = anchor.update(head, nullptr, noise);
  EXPECT_FALSE(out.corrected);
  EXPECT_EQ(out.head.T_world_camera.translation, head.T_world_camera.translation);
  EXPECT_TRUE(out.independent.isZero());
  const Vector3 pivot = head.T_world_camera * Vector3(0, 0, noise.pivot_m);
  const Matrix6 there = out.shared_at(pivot);
  EXPECT_NEAR(there(0, 0), 1e-6, 1e-12);
  EXPECT_NEAR(there(5, 5), 4e-6, 1e-12);
  // 0.5 m away the angle of 2 mrad adds 1 mm.
  const Matrix6 beside = out.shared_at(pivot + Vector3(0.5, 0, 0));
  EXPECT_NEAR(beside(1, 1), 2e-6, 1e-12);
}

TEST(HeadAnchor, IsLessSureWhileTheHeadMoves) {
  const HeadNoise noise;
  HeadDriftCorrection anchor;
  HeadPose head;
  head.valid = true;
  double before = 0;
  for (int frame = 0; frame < 90; ++frame) {
    head.time = Time{} + milliseconds(22) * frame;
    if (frame >= 45) head.T_world_camera.translation.x() += 0.5 * 0.022;
    const CorrectedHead out = anchor.update(head, nullptr, noise);
    if (frame == 44) before = out.shared(0, 0);
    if (frame < 89) continue;
    EXPECT_GT(out.shared(0, 0), 20 * before);
  }
}

TEST(HeadAnchor, MovesWhatIsKnownAlongWhenTheBodyComesBack) {
  HeadNoise noise;
  noise.rest_position_m = 0.01;
  Headset headset(noise, 7);
  HeadDriftCorrection anchor;
  CorrectedHead out;
  for (int frame = 0; frame < 200; ++frame) {
    headset.step();
    const UncertainPose body = headset.body();
    const bool hidden = frame >= 100 && frame < 190;
    if (frame == 150) headset.jump({0.004, 0, 0});
    const Pose before = anchor.corrected(headset.given().T_world_camera);
    out = anchor.update(headset.given(), hidden ? nullptr : &body, noise);
    EXPECT_EQ(out.moved_along, frame == 190) << frame;
    if (frame != 190) continue;
    const Vector3 point(0.05, 0, 0.55);
    const Vector3 was = before * point, is = out.head.T_world_camera * point;
    EXPECT_GT((is - was).norm(), 0.002);
    EXPECT_LT((out.gap_correction * was - is).norm(), 0.0005)
        << "a pose from before lies where it is now";
  }
}

// The step of the world against the previous frame is the change of the headset's error, while the
// body is hidden and when it is visible again.
TEST(HeadAnchor, KnowsByHowMuchTheWorldStepsWhileTheBodyIsHidden) {
  HeadNoise noise;
  noise.rest_position_m = 0.01;
  noise.rest_angle_rad = 0;
  noise.rest_correlation_s = 0.3;
  noise.position_per_speed_s = noise.angle_per_speed_s_m = 0;
  noise.position_per_turn_m = noise.angle_per_turn_s = 0;
  const double kept = std::exp(-0.022 / noise.rest_correlation_s);
  Headset headset(noise, 11);
  HeadDriftCorrection anchor;
  const Vector3 point(0.05, 0, 0.55);
  Vector3 before = Vector3::Zero();
  double chi_square = 0;
  int steps = 0;
  for (int frame = 0; frame < 2000; ++frame) {
    headset.step();
    const Vector3 error = headset.given().T_world_camera * point - point;
    const UncertainPose body = headset.body();
    const bool hidden = frame >= 100 && frame % 4 > 1;
    const CorrectedHead out = anchor.update(headset.given(), hidden ? nullptr : &body, noise);
    EXPECT_EQ(out.in_gap, frame >= 102 && frame % 4 != 1) << frame;
    EXPECT_EQ(out.in_gap, !out.step_covariance.isZero()) << frame;
    const Vector3 step = error - kept * before;
    before = error;
    if (!out.in_gap) continue;
    const Matrix3 covariance = out.step_covariance_at(point).topLeftCorner<3, 3>();
    chi_square += step.dot(covariance.inverse() * step);
    ++steps;
  }
  EXPECT_NEAR(chi_square / steps / 3, 1, 0.1);
}

TEST(HeadAnchor, TakesItsErrorsJitterForNoSpeed) {
  HeadNoise noise;
  noise.rest_position_m = 0.004;
  noise.rest_correlation_s = noise.motion_correlation_s;
  noise.position_per_speed_s = 1;
  noise.position_per_turn_m = noise.angle_per_speed_s_m = noise.angle_per_turn_s = 0;
  Headset headset(noise, 12);
  HeadDriftCorrection anchor;
  double variance = 0;
  constexpr int k_frames = 2000;
  for (int frame = 0; frame < k_frames; ++frame) {
    headset.step();
    (void)anchor.update(headset.given(), nullptr, noise);
    variance += anchor.uncorrected_covariance_at({0, 0, noise.pivot_m})(0, 0) / k_frames;
  }
  // The jitter is 0.1 m/s from frame to frame. If it counted as speed, the error would be 0.1 m.
  EXPECT_LT(std::sqrt(variance), 0.035);
}

// 40 mm back and forth once a second: 0.16 m/s on average, zero displacement after a second.
TEST(HeadAnchor, CountsTheSpeedOfAHeadThatMovesToAndFro) {
  HeadNoise noise;
  noise.rest_position_m = noise.rest_angle_rad = 0;
  noise.position_per_speed_s = 0.1;
  noise.position_per_turn_m = noise.angle_per_speed_s_m = noise.angle_per_turn_s = 0;
  HeadDriftCorrection anchor;
  double sigma_m = 0;
  constexpr int k_frames = 450;
  HeadPose head;
  head.valid = true;
  for (int frame = 0; frame < k_frames; ++frame) {
    const double t = frame * k_frame_s;
    head.time = Time{static_cast<std::int64_t>(t * 1e9)};
    head.T_world_camera.translation.x() = 0.04 * std::sin(6.283185307179586 * t);
    (void)anchor.update(head, nullptr, noise);
    sigma_m += std::sqrt(anchor.uncorrected_covariance_at({0, 0, noise.pivot_m})(0, 0)) / k_frames;
  }
  EXPECT_NEAR(sigma_m, 0.1 * 0.16, 0.1 * 0.05);
}

TEST(HeadAnchor, IgnoresAWrongSightButBelievesTheBodyWhenTheHeadsetHasJumped) {
  const HeadNoise noise;
  Headset headset(noise, 8);
  HeadDriftCorrection anchor;
  for (int frame = 0; frame < 100; ++frame) {
    headset.step();
    UncertainPose body = headset.body();
    if (frame == 80) body.pose.translation.x() += 0.1;
    const CorrectedHead out = anchor.update(headset.given(), &body, noise);
    EXPECT_EQ(out.corrected, frame != 80) << frame;
  }
  EXPECT_EQ(anchor.jumps(), 0);
  headset.jump({0.05, 0, 0});
  CorrectedHead out;
  for (int frame = 0; frame < k_body_rejected_max; ++frame) {
    EXPECT_FALSE(out.corrected && frame > 0);
    headset.step();
    const UncertainPose body = headset.body();
    out = anchor.update(headset.given(), &body, noise);
  }
  EXPECT_TRUE(out.corrected && out.moved_along);
  EXPECT_EQ(anchor.jumps(), 1);
  const Pose placed = out.head.T_world_camera * headset.body_truth();
  EXPECT_LT((placed.translation - anchor.T_world_body().translation).norm(), 0.002);
}

TEST(HeadAnchor, StaysFiniteForStampsAndCovariancesThatAreNone) {
  const HeadNoise noise;
  Headset headset(noise, 9);
  HeadDriftCorrection anchor;
  for (int frame = 0; frame < 200; ++frame) {
    HeadPose head = headset.given();
    head.time = Time{} - milliseconds(frame);  // backwards
    UncertainPose body = headset.body();
    body.covariance.setZero();
    const CorrectedHead out = anchor.update(head, &body, noise);
    ASSERT_TRUE(std::isfinite(out.head.T_world_camera.translation.sum()));
    ASSERT_TRUE(std::isfinite(out.shared.sum() + out.independent.sum()));
  }
}

TEST(HeadAnchor, GivesTheSameBitsEverywhere) {
  const HeadNoise noise;
  test::Random random(10);
  const Pose body_truth{random.rotation(), Vector3(0.1, 0.05, 0.6)};
  HeadDriftCorrection anchor;
  test::BitHash hash;
  HeadPose head;
  head.valid = true;
  for (int frame = 0; frame < 300; ++frame) {
    head.time = Time{} + milliseconds(22) * frame;
    head.T_world_camera.translation += random.vector(0.0005);
    const UncertainPose body =
        test::measured_pose(body_truth, {}, k_body_shift_sigma, k_body_rotation_sigma_rad, random);
    const CorrectedHead out = anchor.update(head, frame % 50 < 40 ? &body : nullptr, noise);
    hash.add(out.head.T_world_camera);
    for (int i = 0; i < 6; ++i) hash.add(out.shared(i, 5 - i) + out.independent(i, i));
  }
  EXPECT_EQ(hash.value(), 12037544854358833628u);
}

}  // namespace
}  // namespace glint
