// Adaptation of a motion track's process noise to its innovations against the formulas, step by
// step; updates by poses and by single markers.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <span>

#include "kernels/motion/motion_track.hpp"
#include "kernels/motion/occlusion_noise.hpp"
#include "tests/unit/kernels/motion/motion_scene.hpp"

namespace glint::track_adaptation_test {
namespace {

using test::Random;

constexpr double k_frame_s = 0.022222222;

struct Track {
  MotionTrack at;
  std::unique_ptr<StaticWindowSums> sums = std::make_unique<StaticWindowSums>();
  ToolMotionSettings settings;

  // Without static detection: the estimate is the filter's.
  static Track without_static_detection() {
    Track track;
    track.settings.rest.frames_min = 1000;
    return track;
  }
  Reason update(const UncertainPose& measured) {
    return at.update(measured, {}, settings, *sums).reason;
  }
  Reason update(Time time, std::span<const MeasuredPoint> points) {
    return at.update(time, points, settings, *sums);
  }
  [[nodiscard]] MotionState estimate() const { return at.estimate(*sums); }
};

UncertainPose seen(const Pose& truth, Time time, Random& random) {
  return test::measured_pose(truth, time, 0.0005, 0.005, random);
}

constexpr double k_manoeuvre_nis = 21.11;  // quantile 1 - 1e-4, 3 degrees of freedom

// Beyond it the translation's covariance grows until the NIS is 3. Returns the innovation, whitened
// before that.
Vector3 admit_manoeuvre(const UncertainPose& measured, MotionState& ahead) {
  const Matrix3 expected =
      ahead.covariance.topLeftCorner<3, 3>() + measured.covariance.topLeftCorner<3, 3>();
  const Vector3 innovation = measured.pose.translation - ahead.pose.translation;
  const Vector3 whitened = expected.llt().matrixL().solve(innovation);
  const double nis = whitened.squaredNorm();
  if (nis <= k_manoeuvre_nis) return whitened;
  MotionCovariance grown = MotionCovariance::Identity();
  grown.topLeftCorner<9, 9>() *= std::sqrt(nis / 3);
  ahead.covariance = (grown * ahead.covariance * grown).eval();
  return whitened;
}

double clamped(double scale, const AdaptationSettings& settings) {
  return std::min(std::max(scale, settings.floor), settings.ceiling);
}

// A tool that swings, is static and is measured at irregular times. Each factor follows its own
// chi-square, by the number of frames elapsed, at most four.
TEST(TrackAdaptation, MovesEachFactorByItsChiSquareAndTheTimePassed) {
  Random random(1);
  Track track = Track::without_static_detection();
  track.settings.linear = {9, 0.5, 3, 2};
  track.settings.angular = {7, 0.3, 5, 4};
  track.settings.peak_scale_frames = 50;
  track.settings.partial_visibility_noise = 1.5;
  double linear = 1, angular = 1, linear_scale_max = 1, angular_scale_max = 1;
  Time time;
  Pose truth{random.rotation(), random.vector(0.3)};
  int at_floor = 0, at_ceiling = 0, manoeuvres = 0;
  for (int frame = 0; frame < 400; ++frame) {
    const Duration step = milliseconds(frame % 10 == 0 ? 150 : 15 + frame % 20);
    time = time + step;
    if (frame / 40 % 2 == 1) {
      truth.translation += random.vector(0.02);
      truth.rotation = (from_rotation_vector(random.vector(0.1)) * truth.rotation).normalized();
    }
    const UncertainPose measured = seen(truth, time, random);
    MotionState ahead = track.estimate();
    propagate(ahead, time, track.settings.motion, track.at.noise_scale());
    ASSERT_EQ(track.update(measured), Reason::none);
    if (frame == 0) {
      EXPECT_EQ(track.at.noise_scale().linear, 1);
      EXPECT_EQ(track.at.partial_visibility_noise_scale(track.settings).angular, 1.5);
      continue;
    }
    const Correction& correction = track.at.last_correction();
    const double frames = std::min(step.seconds() / k_frame_s, 4.0);
    const double nis = admit_manoeuvre(measured, ahead).squaredNorm();
    manoeuvres += nis > k_manoeuvre_nis ? 1 : 0;
    const double by_linear = std::min(nis / 3, 2.0);
    const double by_angular = std::min(correction.angular_nis / 3, 4.0);
    linear = clamped(linear * (1 + (by_linear - 1) * frames / 9), track.settings.linear);
    angular = clamped(angular * (1 + (by_angular - 1) * frames / 7), track.settings.angular);
    linear_scale_max = std::max(linear, linear_scale_max * (1 - 1.0 / 50));
    angular_scale_max = std::max(angular, angular_scale_max * (1 - 1.0 / 50));
    EXPECT_NEAR(track.at.noise_scale().linear, linear, 1e-9) << frame;
    EXPECT_NEAR(track.at.noise_scale().angular, angular, 1e-9) << frame;
    const NoiseScale partial = track.at.partial_visibility_noise_scale(track.settings);
    EXPECT_NEAR(partial.linear, 1.5 * linear_scale_max, 1e-9) << frame;
    EXPECT_NEAR(partial.angular, 1.5 * angular_scale_max, 1e-9) << frame;
    at_floor += linear == 0.5 ? 1 : 0;
    at_ceiling += angular == 5 ? 1 : 0;
    ASSERT_FALSE(HasFailure()) << frame;
  }
  EXPECT_GT(at_floor, 5);
  EXPECT_GT(at_ceiling, 5);
  EXPECT_GT(manoeuvres, 5);
}

// Each update propagates the filter's mean and covariance with the previous factors, then corrects
// them.
TEST(TrackAdaptation, PropagatesWithItsFactorsAndCorrects) {
  Random random(2);
  Track track = Track::without_static_detection();
  Pose truth{random.rotation(), random.vector(0.3)};
  int manoeuvres = 0;
  for (int frame = 0; frame < 60; ++frame) {
    const Time time = test::frame_time(frame);
    truth.translation += random.vector(0.01);
    MotionState expected = track.estimate();
    const UncertainPose measured = seen(truth, time, random);
    const NoiseScale before = track.at.noise_scale();
    ASSERT_EQ(track.update(measured), Reason::none);
    if (frame == 0) continue;
    propagate(expected, time, track.settings.motion, before);
    const bool manoeuvre = admit_manoeuvre(measured, expected).squaredNorm() > k_manoeuvre_nis;
    manoeuvres += manoeuvre ? 1 : 0;
    (void)correct_by_pose(expected, measured);
    if (!manoeuvre) {
      EXPECT_EQ(track.estimate().covariance, expected.covariance);
      EXPECT_EQ(track.estimate().velocity_m_s, expected.velocity_m_s);
      EXPECT_EQ(track.at.place(), expected.pose.translation);
    }
    EXPECT_LT((track.estimate().covariance - expected.covariance).norm(),
              1e-9 * expected.covariance.norm());
    EXPECT_LT((track.estimate().velocity_m_s - expected.velocity_m_s).norm(), 1e-9);
    EXPECT_LT((track.at.place() - expected.pose.translation).norm(), 1e-12);
  }
  EXPECT_GT(manoeuvres, 5);
}

// A random covariance is added in each frame. Its factor follows the correlation of successive
// innovations; the linear noise factor follows the remaining share of the innovation.
TEST(TrackAdaptation, CountsALooseningByTheCorrelationOfInnovations) {
  Random random(3);
  Track track = Track::without_static_detection();
  track.settings.inflation = {6, 0.05, 4, 0.6};
  double factor = 1, linear = 1;
  Vector3 last = Vector3::Zero();
  Pose truth{random.rotation(), random.vector(0.3)};
  int lowered = 0, raised = 0;
  double least = 1, most = 1;
  for (int frame = 0; frame < 300; ++frame) {
    const Time time = test::frame_time(frame);
    truth.translation += frame / 50 % 2 == 0 ? Vector3(0.004, 0, 0) : random.vector(0.01);
    Matrix6 step = test::random_covariance<6>(random, 0.002);
    if (frame > 0) {
      const MotionCovariance before = track.estimate().covariance;
      track.at.inflate_covariance(step);
      const MotionCovariance added = track.estimate().covariance - before;
      for (int i = 0; i < 6; ++i)
        for (int j = 0; j < 6; ++j)
          EXPECT_NEAR(added(i < 3 ? i : 6 + i, j < 3 ? j : 6 + j), factor * step(i, j), 1e-12);
      EXPECT_EQ(added(k_velocity, k_velocity), 0);
      EXPECT_EQ(added(k_position, k_velocity), 0);
    }
    MotionState ahead = track.estimate();
    const UncertainPose measured = seen(truth, time, random);
    propagate(ahead, time, track.settings.motion, track.at.noise_scale());
    ASSERT_EQ(track.update(measured), Reason::none);
    if (frame == 0) continue;
    const double frames = (test::frame_time(1) - Time{}).seconds() / k_frame_s;
    const double expected = ahead.covariance.topLeftCorner<3, 3>().trace() +
                            measured.covariance.topLeftCorner<3, 3>().trace();
    const double share = factor * step.topLeftCorner<3, 3>().trace() / expected;
    const Vector3 whitened = admit_manoeuvre(measured, ahead);
    const double along = share * whitened.dot(last) / 3;
    const double turned = std::min(std::max(along, -0.6), 0.6) * frames / 6;
    const double before = factor;
    factor = std::min(std::max(factor * (1 - turned), 0.05), 4.0);
    last = whitened;
    const double ratio = std::min(whitened.squaredNorm() / 3, track.settings.linear.nis_ratio_max);
    linear =
        clamped(linear * (1 + (ratio - 1) * (1 - share) * frames / track.settings.linear.frames),
                track.settings.linear);
    EXPECT_NEAR(track.at.noise_scale().linear, linear, 1e-9) << frame;
    lowered += factor < before ? 1 : 0;
    raised += factor > before ? 1 : 0;
    least = std::min(least, factor);
    most = std::max(most, factor);
    ASSERT_FALSE(HasFailure()) << frame;
  }
  EXPECT_GT(lowered, 50);
  EXPECT_GT(raised, 50);
  EXPECT_LT(least, 0.9);
  EXPECT_GT(most, 1.1);
}

// One and two markers after one pose or many: the prediction uses the largest recent process noise
// plus the process noise during occlusion since the newest pose.
TEST(TrackAdaptation, FollowsMarkersWithStrokesAndTheBriskestNoise) {
  for (const int poses : {1, 40}) {
    Random random(4);
    Track track = Track::without_static_detection();
    Pose truth{random.rotation(), random.vector(0.3)};
    const auto move_on = [&] { truth.translation += Vector3(0.004, 0.001, 0); };
    for (int frame = 100; frame < 100 + poses; ++frame, move_on())
      ASSERT_EQ(track.update(seen(truth, test::frame_time(frame), random)), Reason::none);
    const int last = 99 + poses;
    for (int frame = last + 1; frame < last + 7; ++frame, move_on()) {
      const Time time = test::frame_time(frame);
      std::array<MeasuredPoint, 3> points;
      for (MeasuredPoint& point : points) {
        point.model_m = random.vector(0.05);
        point.measured_m = truth * point.model_m + random.vector(0.0003);
        point.covariance_m2 = 9e-8 * Matrix3::Identity();
      }
      MotionState expected = track.estimate();
      const double seconds = (time - expected.time).seconds();
      const double hidden_s = (time - test::frame_time(last)).seconds();
      propagate(expected, time, track.settings.motion,
                track.at.partial_visibility_noise_scale(track.settings));
      add_occlusion_noise(expected.covariance, k_position, expected.velocity_m_s,
                          linear_occlusion_share_1_s(expected.velocity_m_s), hidden_s, seconds);
      add_occlusion_noise(expected.covariance, k_rotation, expected.angular_velocity_rad_s,
                          k_angular_occlusion_share_1_s, hidden_s, seconds);
      const std::size_t count = frame % 2 == 0 ? 1 : 3;  // a third marker is ignored
      for (std::size_t i = 0; i < std::min<std::size_t>(count, 2); ++i)
        (void)correct_by_point(expected, points[i]);
      ASSERT_EQ(track.update(time, std::span(points).first(count)), Reason::none);
      EXPECT_EQ(track.estimate().time, time);
      EXPECT_EQ(track.estimate().covariance, expected.covariance) << frame;
      EXPECT_EQ(track.estimate().pose.translation, expected.pose.translation) << frame;
    }
  }
}

}  // namespace
}  // namespace glint::track_adaptation_test
