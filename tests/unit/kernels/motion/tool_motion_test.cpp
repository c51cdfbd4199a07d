#include "kernels/motion/tool_motion.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>

#include "kernels/motion/interpolate.hpp"
#include "kernels/motion/occlusion_noise.hpp"
#include "platform/dense.hpp"
#include "tests/unit/heap_count.hpp"
#include "tests/unit/kernels/motion/motion_scene.hpp"

namespace glint::tool_motion_test {
namespace {

constexpr double k_shift_sigma = 0.0005, k_turn_sigma = 0.005;

UncertainPose seen(const Pose& truth, int frame, test::Random& random) {
  return test::measured_pose(truth, test::frame_time(frame), k_shift_sigma, k_turn_sigma, random);
}

struct Followed {
  test::Random random{1};
  Pose truth{random.rotation(), random.vector(0.3)};
  std::unique_ptr<ToolMotion> motion = std::make_unique<ToolMotion>();
  int frame = 0;

  void rest(int frames) {
    for (int i = 0; i < frames; ++i)
      ASSERT_EQ(motion->update(seen(truth, frame++, random)), Reason::none);
  }
};

TEST(ToolMotion, StandsStillAtRest) {
  Followed tool;
  tool.rest(90);
  ASSERT_TRUE(tool.motion->is_static());
  const MotionState state = tool.motion->estimate();
  EXPECT_EQ(state.velocity_m_s, Vector3(Vector3::Zero()));
  EXPECT_LT((state.pose.translation - tool.truth.translation).norm(), 4 * k_shift_sigma / 9);
  EXPECT_LT(std::sqrt(state.covariance(0, 0)), 1.5 * k_shift_sigma / std::sqrt(90.0));
  EXPECT_EQ(state.time, test::frame_time(89));
}

TEST(ToolMotion, IsKnownFromItsFirstPoseUntilItIsForgotten) {
  Followed tool;
  EXPECT_FALSE(tool.motion->known());
  tool.rest(1);
  EXPECT_TRUE(tool.motion->known());
  tool.motion->reset();
  EXPECT_FALSE(tool.motion->known());
}

TEST(ToolMotion, RefusesStampsThatDoNotRiseAndKeepsItsState) {
  Followed tool;
  tool.rest(5);
  const MotionState before = tool.motion->estimate();
  EXPECT_EQ(tool.motion->update(seen(tool.truth, 4, tool.random)), Reason::frame_duplicate);
  EXPECT_EQ(tool.motion->update(seen(tool.truth, 2, tool.random)), Reason::frame_late);
  MeasuredPoint point;
  point.covariance_m2 = 1e-6 * Matrix3::Identity();
  EXPECT_EQ(tool.motion->update(test::frame_time(4), {&point, 1}), Reason::frame_duplicate);
  EXPECT_EQ(tool.motion->update(test::frame_time(3), {&point, 1}), Reason::frame_late);
  EXPECT_EQ(tool.motion->estimate().covariance, before.covariance);
  EXPECT_EQ(tool.motion->estimate().pose.translation, before.pose.translation);
}

TEST(ToolMotion, RefusesWhatIsNoPose) {
  Followed tool;
  tool.rest(5);
  const MotionState before = tool.motion->estimate();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto refused = [&](auto&& spoil) {
    UncertainPose measured = seen(tool.truth, tool.frame, tool.random);
    spoil(measured);
    return tool.motion->update(measured) == Reason::out_of_range;
  };
  EXPECT_TRUE(refused([&](UncertainPose& m) { m.pose.translation.x() = nan; }));
  EXPECT_TRUE(refused([&](UncertainPose& m) { m.pose.translation.x() = 1e200; }));
  EXPECT_TRUE(refused([&](UncertainPose& m) { m.pose.rotation.w() = nan; }));
  EXPECT_TRUE(refused([&](UncertainPose& m) { m.covariance(2, 1) = nan; }));
  EXPECT_TRUE(refused([](UncertainPose& m) { m.covariance.setZero(); }));
  EXPECT_TRUE(refused([](UncertainPose& m) { m.covariance *= 1e20; }));
  MeasuredPoint point{Vector3::Zero(), Vector3(nan, 0, 0), 1e-6 * Matrix3::Identity()};
  EXPECT_EQ(tool.motion->update(test::frame_time(5), {&point, 1}), Reason::out_of_range);
  EXPECT_EQ(tool.motion->estimate().pose.translation, before.pose.translation);
  EXPECT_EQ(tool.motion->estimate().covariance, before.covariance);
}

// Rms error of a one-frame prediction of a swinging tool, in a world that jitters by `jitter_m` a
// frame. The declared jitter is 10 mm.
double prediction_rms_m(double jitter_m, bool inflated) {
  Followed tool;
  constexpr double k_declared_m = 0.01, k_rad_s = 6;
  const Vector3 middle = tool.truth.translation;
  Matrix6 step = Matrix6::Zero();
  step.diagonal().head<3>().setConstant(k_declared_m * k_declared_m);
  Vector3 world = Vector3::Zero();
  double squares = 0;
  constexpr int k_frames = 900, k_first = 100;
  MotionTrack track;
  ToolMotionSettings settings;
  auto sums = std::make_unique<StaticWindowSums>();
  for (int frame = 0; frame < k_frames; ++frame) {
    const double t = (test::frame_time(frame) - Time{}).seconds();
    world += tool.random.vector(jitter_m);
    tool.truth.translation = middle + world + Vector3(0.2 * std::sin(k_rad_s * t), 0, 0);
    if (inflated && frame > 0) track.inflate_covariance(step);
    if (frame > k_first) {
      MotionState ahead = track.estimate(*sums);
      propagate(ahead, test::frame_time(frame), settings.motion, track.noise_scale());
      squares += (ahead.pose.translation - tool.truth.translation).squaredNorm();
    }
    EXPECT_EQ(track.update(seen(tool.truth, frame, tool.random), {}, settings, *sums).reason,
              Reason::none);
  }
  return std::sqrt(squares / (k_frames - k_first - 1));
}

TEST(ToolMotion, LearnsHowMuchOfADeclaredJitterThereIs) {
  const double quiet = prediction_rms_m(0, false);
  EXPECT_LT(prediction_rms_m(0, true), 1.6 * quiet);
  const double least = std::sqrt(3.0) * 0.01;  // no filter can predict the newest step
  EXPECT_LT(prediction_rms_m(0.01, true), 1.2 * least);
  EXPECT_GT(prediction_rms_m(0.01, false), 1.25 * least);
}

TEST(ToolMotion, StartsAnewAfterALongSilence) {
  Followed tool;
  tool.rest(50);
  tool.frame += 60;  // 1.3 s
  tool.truth.translation += Vector3(0.5, 0, 0);
  const UncertainPose measured = seen(tool.truth, tool.frame, tool.random);
  ASSERT_EQ(tool.motion->update(measured), Reason::none);
  EXPECT_EQ(tool.motion->estimate().pose.translation, measured.pose.translation);
  EXPECT_FALSE(tool.motion->is_static());
}

TEST(ToolMotion, GoesOnWithOneMarkerButNeedsAPoseFirst) {
  Followed tool;
  const Vector3 model(0.02, 0.03, 0);
  const auto marker = [&] {
    return MeasuredPoint{model, tool.truth * model + tool.random.vector(0.0003),
                         9e-8 * Matrix3::Identity()};
  };
  MeasuredPoint point = marker();
  EXPECT_EQ(tool.motion->update(test::frame_time(0), {&point, 1}), Reason::too_few_markers);
  tool.rest(40);
  for (int i = 0; i < 9; ++i) {
    tool.truth.translation += Vector3(0.002, 0, 0);
    point = marker();
    ASSERT_EQ(tool.motion->update(test::frame_time(tool.frame++), {&point, 1}), Reason::none);
    EXPECT_FALSE(tool.motion->is_static());
  }
  const MotionState state = tool.motion->estimate();
  const double sigma = std::sqrt(state.covariance.topLeftCorner<3, 3>().trace());
  EXPECT_LT((state.pose.translation - tool.truth.translation).norm(), 4 * sigma);
  EXPECT_LT(sigma, 0.005);
  EXPECT_EQ(tool.motion->update(test::frame_time(tool.frame + 100), {&point, 1}),
            Reason::too_few_markers);
}

// A marker on the axis of rotation does not observe that rotation.
TEST(ToolMotion, GrowsUnsureAlongATurnThatOneMarkerDoesNotShow) {
  Followed tool;
  tool.truth.rotation = Quaternion::Identity();
  const Vector3 turn(0, 0, 2), model(0, 0, 0.05);
  const auto turn_on = [&] {
    tool.truth.rotation =
        (from_rotation_vector(turn * (1 / 45.0)) * tool.truth.rotation).normalized();
  };
  for (int i = 0; i < 90; ++i) {
    turn_on();
    ASSERT_EQ(tool.motion->update(seen(tool.truth, tool.frame++, tool.random)), Reason::none);
  }
  for (int i = 0; i < 9; ++i) {
    turn_on();
    const MeasuredPoint point{model, tool.truth * model, 9e-8 * Matrix3::Identity()};
    ASSERT_EQ(tool.motion->update(test::frame_time(tool.frame++), {&point, 1}), Reason::none);
  }
  const double stroke =
      k_angular_occlusion_share_1_s * 2 * 0.2 * 0.2;  // rad, twice the angle error
  EXPECT_GT(tool.motion->estimate().covariance(k_rotation + 2, k_rotation + 2),
            0.9 * stroke * stroke / 6);
}

TEST(ToolMotion, KeepsItsNoiseAboveTheFloorWithoutAnyNoise) {
  Followed tool;
  UncertainPose measured = seen(tool.truth, 0, tool.random);
  measured.pose = tool.truth;
  for (int frame = 0; frame < 1000; ++frame) {
    measured.time = test::frame_time(frame);
    ASSERT_EQ(tool.motion->update(measured), Reason::none);
  }
  EXPECT_EQ(tool.motion->noise_scale().linear, tool.motion->settings.linear.floor);
  EXPECT_EQ(tool.motion->noise_scale().angular, tool.motion->settings.angular.floor);
}

TEST(ToolMotion, IsAsSureAsItIsRight) {
  test::Random random(9);
  const auto motion = std::make_unique<ToolMotion>();
  double squares = 0;
  int n = 0;
  for (int frame = 0; frame < 5000; ++frame) {
    const double t = frame / 45.0;
    const Pose truth{from_rotation_vector({0.5 * std::sin(2 * t), 0.4 * std::sin(3 * t), 0}),
                     {0.1 * std::sin(2.5 * t), 0.1 * std::sin(3.3 * t), 0.05 * std::sin(4 * t)}};
    ASSERT_EQ(motion->update(seen(truth, frame, random)), Reason::none);
    if (frame < 45) continue;
    const UncertainPose estimate = pose_of(motion->estimate());
    const Vector6 error = pose_difference(truth, estimate.pose);
    squares += error.dot(Matrix6(inverse_of(estimate.covariance)) * error) / 6;
    ++n;
  }
  EXPECT_NEAR(squares / n, 1.0, 0.3);
}

TEST(ToolMotion, AsksForNoMemory) {
  Followed tool;
  tool.rest(2);
  const HeapCount heap;
  tool.rest(200);
  (void)tool.motion->estimate();
  EXPECT_EQ(heap.count(), 0u);
}

TEST(ToolMotion, GivesTheSameBitsEverywhere) {
  Followed tool;
  test::BitHash hash;
  for (int frame = 0; frame < 600; ++frame) {
    if (frame % 90 > 40) tool.truth.translation += tool.random.vector(0.003);
    if (frame % 90 < 80) {
      ASSERT_EQ(tool.motion->update(seen(tool.truth, frame, tool.random)), Reason::none);
    } else {
      MeasuredPoint point{Vector3(0, 0.03, 0), Vector3::Zero(), 1e-6 * Matrix3::Identity()};
      point.measured_m = tool.truth * point.model_m;
      ASSERT_EQ(tool.motion->update(test::frame_time(frame), {&point, 1}), Reason::none);
    }
    test::add_bits(hash, tool.motion->estimate());
  }
  EXPECT_EQ(hash.value(), 2011493776577771427u);
}

// Static poses with errors correlated over 0.5 s and over 20 s: 40 runs of 30 s at 5 Hz. The
// detector fires, and errors match the stated covariance with its correlated part. Without that
// part they are many times as large.
TEST(ToolMotion, StatesCorrelatedErrorsBesideItsCovariance) {
  constexpr double k_fast_m = 0.0004, k_slow_m = 0.0003, k_period_s = 0.2;
  constexpr CorrelationTimes k_times{0.5, 20};
  CorrelatedErrors stated;
  stated.fast.diagonal() << Vector3::Constant(k_fast_m * k_fast_m), Vector3::Zero();
  stated.slow.diagonal() << Vector3::Constant(k_slow_m * k_slow_m), Vector3::Zero();
  const double keep_fast = std::exp(-k_period_s / k_times.fast_s);
  const double keep_slow = std::exp(-k_period_s / k_times.slow_s);
  test::Random random(5);
  double with = 0, without = 0;
  int n = 0, rests = 0;
  for (int run = 0; run < 40; ++run) {
    const auto motion = std::make_unique<ToolMotion>();
    motion->settings.rest.correlation = k_times;
    Vector3 fast = random.vector(k_fast_m), slow = random.vector(k_slow_m);
    const Pose truth{random.rotation(), random.vector(0.3)};
    for (int frame = 0; frame < 150; ++frame) {
      fast = keep_fast * fast + std::sqrt(1 - keep_fast * keep_fast) * random.vector(k_fast_m);
      slow = keep_slow * slow + std::sqrt(1 - keep_slow * keep_slow) * random.vector(k_slow_m);
      UncertainPose measured =
          test::measured_pose(truth, Time{} + milliseconds(200) * frame, 0.0001, 0.001, random);
      measured.pose.translation += fast + slow;
      ASSERT_EQ(motion->update(measured, stated), Reason::none);
      if (frame < 10) continue;
      const Matrix6 random_part = pose_of(motion->estimate()).covariance;
      const Matrix3 total = (random_part + motion->correlated_covariance()).topLeftCorner<3, 3>();
      const Vector3 error = motion->estimate().pose.translation - truth.translation;
      with += error.dot(total.inverse() * error) / 3;
      without += error.dot(random_part.topLeftCorner<3, 3>().inverse() * error) / 3;
      rests += motion->is_static() ? 1 : 0;
      ++n;
    }
  }
  EXPECT_GT(with / n, 0.7);
  EXPECT_LT(with / n, 1.3);
  EXPECT_GT(without / n, 5);
  EXPECT_GT(rests, 0.95 * n);
}

}  // namespace
}  // namespace glint::tool_motion_test
