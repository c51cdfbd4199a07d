// Limits of a motion track: accepted measurements, reset after a gap, and the static estimate.
#include <gtest/gtest.h>

#include <memory>
#include <span>

#include "kernels/motion/motion_track.hpp"
#include "kernels/motion/occlusion_noise.hpp"
#include "kernels/motion/tool_motion.hpp"
#include "tests/unit/kernels/motion/motion_scene.hpp"

namespace glint::track_limits_test {
namespace {

using test::Random;

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

TEST(TrackLimits, TakeAPoseAtEachAndNoneBeyond) {
  Random random(5);
  const UncertainPose usual = seen({Quaternion::Identity(), Vector3(0, 0, 0.5)}, Time{5}, random);
  const auto reason = [&](auto&& change) {
    UncertainPose measured = usual;
    change(measured);
    return Track{}.update(measured);
  };
  const Reason good = Reason::none, bad = Reason::out_of_range;
  EXPECT_EQ(reason([](UncertainPose&) {}), good);
  EXPECT_EQ(reason([](UncertainPose& m) { m.pose.translation = {1000, 0, 0}; }), good);
  EXPECT_EQ(reason([](UncertainPose& m) { m.pose.translation = {0, -1000.001, 0}; }), bad);
  EXPECT_EQ(reason([](UncertainPose& m) { m.pose.rotation.coeffs() *= 1 + 0.9e-6; }), good);
  EXPECT_EQ(reason([](UncertainPose& m) { m.pose.rotation.coeffs() *= 1 + 1.1e-6; }), bad);
  EXPECT_EQ(reason([](UncertainPose& m) { m.pose.rotation.coeffs() *= 1 - 0.9e-6; }), good);
  EXPECT_EQ(reason([](UncertainPose& m) { m.pose.rotation.coeffs() *= 1 - 1.1e-6; }), bad);
  EXPECT_EQ(reason([](UncertainPose& m) { m.covariance = Matrix6::Identity() * 0.9999e6 / 6; }),
            good);
  EXPECT_EQ(reason([](UncertainPose& m) { m.covariance = Matrix6::Identity() * 1.0001e6 / 6; }),
            bad);
  EXPECT_EQ(reason([](UncertainPose& m) { m.covariance(5, 5) = 0; }), bad);
  EXPECT_EQ(reason([](UncertainPose& m) { m.covariance(0, 0) = -1; }), bad);
}

// A gap of exactly the limit continues the motion, a longer one restarts it. Single markers need a
// pose within the gap.
TEST(TrackLimits, GoOnAfterASilenceOfTheGapAndNoLonger) {
  for (const std::int64_t beyond : {0, 1}) {
    Random random(6);
    Track track = Track::without_static_detection();
    Pose truth{random.rotation(), random.vector(0.3)};
    for (int frame = 0; frame < 20; ++frame) {
      truth.translation += random.vector(0.02);
      ASSERT_EQ(track.update(seen(truth, test::frame_time(frame), random)), Reason::none);
    }
    EXPECT_NE(track.at.noise_scale().linear, 1);
    const Time late = test::frame_time(19) + track.settings.gap_max + Duration{beyond};
    MeasuredPoint point{Vector3::Zero(), truth.translation, 1e-4 * Matrix3::Identity()};
    Track markers = Track::without_static_detection();
    markers.at = track.at;
    EXPECT_EQ(markers.update(late, {&point, 1}),
              beyond == 0 ? Reason::none : Reason::too_few_markers);
    EXPECT_EQ(markers.update(test::frame_time(20), {}),
              beyond == 0 ? Reason::frame_late : Reason::too_few_markers);
    const UncertainPose measured = seen(truth, late, random);
    ASSERT_EQ(track.update(measured), Reason::none);
    const bool anew = track.estimate().pose.translation == measured.pose.translation;
    EXPECT_EQ(anew, beyond == 1);
    EXPECT_EQ(track.at.noise_scale().linear == 1, beyond == 1);
  }
}

// After a reset each value equals that of a new track.
TEST(TrackLimits, LeaveNothingOfAForgottenMotion) {
  Random random(7);
  Track used, fresh;
  Pose truth{random.rotation(), random.vector(0.3)};
  Matrix6 step = Matrix6::Identity() * 1e-6;
  for (int frame = 0; frame < 60; ++frame) {
    truth.translation += random.vector(0.01);
    if (frame % 7 == 3) used.at.inflate_covariance(step);
    ASSERT_EQ(used.update(seen(truth, test::frame_time(frame), random)), Reason::none);
  }
  used.at.reset();
  EXPECT_FALSE(used.at.known());
  EXPECT_FALSE(used.at.is_static());
  EXPECT_EQ(used.at.noise_scale().linear, 1);
  EXPECT_EQ(used.at.noise_scale().angular, 1);
  EXPECT_EQ(used.at.partial_visibility_noise_scale(used.settings).linear,
            used.settings.partial_visibility_noise);
  for (int frame = 0; frame < 120; ++frame) {  // time stamps begin before those of the reset motion
    if (frame > 60) truth.translation += random.vector(0.004);
    const UncertainPose measured = seen(truth, test::frame_time(frame), random);
    // Also before the second pose, whose innovation is the first one.
    if (frame == 1 || frame % 9 == 8) {
      used.at.inflate_covariance(step);
      fresh.at.inflate_covariance(step);
    }
    ASSERT_EQ(used.update(measured), Reason::none);
    ASSERT_EQ(fresh.update(measured), Reason::none);
    ASSERT_EQ(used.at.is_static(), fresh.at.is_static()) << frame;
    ASSERT_EQ(used.estimate().covariance, fresh.estimate().covariance) << frame;
    ASSERT_EQ(used.estimate().pose.translation, fresh.estimate().pose.translation) << frame;
    ASSERT_EQ(used.at.noise_scale().linear, fresh.at.noise_scale().linear) << frame;
    ASSERT_EQ(used.at.noise_scale().angular, fresh.at.noise_scale().angular) << frame;
    ASSERT_EQ(used.at.last_correction().nis, fresh.at.last_correction().nis);
    ASSERT_EQ(used.at.partial_visibility_noise_scale(used.settings).linear,
              fresh.at.partial_visibility_noise_scale(fresh.settings).linear);
  }
}

// Static: mean and drift of the window, the filter's accelerations, and zero covariance between
// them.
TEST(TrackAtRest, EstimatesWhatTheWindowSaysAndWhatTheFilterSaysOfAccelerations) {
  Random random(8);
  Track resting, filter = Track::without_static_detection();
  auto window = std::make_unique<StaticDetector>();
  auto sums = std::make_unique<StaticWindowSums>();
  Pose truth{random.rotation(), random.vector(0.3)};
  CorrelatedErrors correlated;
  correlated.fast = test::random_covariance<6>(random, 0.0001);
  correlated.slow = test::random_covariance<6>(random, 0.0001);
  int rests = 0, drifts = 0;
  for (int frame = 0; frame < 80; ++frame) {
    truth.translation += Vector3(0.00006, 0, 0);
    const UncertainPose measured = seen(truth, test::frame_time(frame), random);
    const MotionUpdate update =
        resting.at.update(measured, correlated, resting.settings, *resting.sums);
    ASSERT_EQ(update.reason, Reason::none);
    ASSERT_EQ(filter.at.update(measured, correlated, filter.settings, *filter.sums).reason,
              Reason::none);
    EXPECT_EQ(update.static_tests, window->add(measured, correlated, resting.settings.rest, *sums));
    ASSERT_EQ(resting.at.is_static(), window->is_static());
    EXPECT_EQ(resting.at.correlated_covariance(*resting.sums), window->correlated(*sums));
    const MotionState state = resting.estimate();
    EXPECT_EQ(state.time, measured.time);
    if (!window->is_static()) {
      EXPECT_EQ(state.covariance, filter.estimate().covariance);
      continue;
    }
    ++rests;
    const StaticEstimate rest = window->rest(*sums);
    drifts += rest.drift_per_s.isZero() ? 0 : 1;
    EXPECT_EQ(state.pose.translation, rest.pose.pose.translation);
    EXPECT_EQ(state.pose.rotation.coeffs(), rest.pose.pose.rotation.coeffs());
    EXPECT_EQ(state.velocity_m_s, Vector3(rest.drift_per_s.head<3>()));
    EXPECT_EQ(state.angular_velocity_rad_s, Vector3(rest.drift_per_s.tail<3>()));
    EXPECT_EQ(state.acceleration_m_s2, Vector3(0, 0, 0));
    EXPECT_EQ(state.angular_acceleration_rad_s2, Vector3(0, 0, 0));
    EXPECT_EQ(pose_of(state).covariance, rest.pose.covariance);
    MotionCovariance left = state.covariance;
    const MotionCovariance own = filter.estimate().covariance;
    const auto take = [&](int at, const Matrix3& expected) {
      EXPECT_EQ(Matrix3(left.block<3, 3>(at, at)), expected) << at;
      left.block<3, 3>(at, at).setZero();
    };
    take(k_velocity, rest.drift_covariance.topLeftCorner<3, 3>());
    take(k_angular_velocity, rest.drift_covariance.bottomRightCorner<3, 3>());
    take(k_acceleration, own.block<3, 3>(k_acceleration, k_acceleration));
    take(k_angular_acceleration, own.block<3, 3>(k_angular_acceleration, k_angular_acceleration));
    left.block<3, 3>(k_position, k_position).setZero();
    left.block<3, 3>(k_position, k_rotation).setZero();
    left.block<3, 3>(k_rotation, k_position).setZero();
    left.block<3, 3>(k_rotation, k_rotation).setZero();
    EXPECT_TRUE(left.isZero());
    ASSERT_FALSE(HasFailure()) << frame;
  }
  EXPECT_GT(rests, 50);
  EXPECT_GT(drifts, 3);
}

// After a static phase single markers continue from the static estimate, inflated by what
// inflate_covariance() has added since.
TEST(TrackAtRest, GivesMarkersWhatWasLoosenedSince) {
  Random random(9);
  Track track;
  const Pose truth{random.rotation(), random.vector(0.3)};
  for (int frame = 0; frame < 40; ++frame)
    ASSERT_EQ(track.update(seen(truth, test::frame_time(frame), random)), Reason::none);
  ASSERT_TRUE(track.at.is_static());
  const Matrix6 step = test::random_covariance<6>(random, 0.001);
  MotionState expected = track.estimate();
  track.at.inflate_covariance(step);
  EXPECT_EQ(track.estimate().covariance, expected.covariance) << "a rest's mean is not loosened";
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j)
      expected.covariance(i < 3 ? i : 6 + i, j < 3 ? j : 6 + j) += step(i, j);
  const Time time = test::frame_time(40);
  propagate(expected, time, track.settings.motion,
            track.at.partial_visibility_noise_scale(track.settings));
  const double seconds = (test::frame_time(1) - Time{}).seconds();
  add_occlusion_noise(expected.covariance, k_position, expected.velocity_m_s,
                      linear_occlusion_share_1_s(expected.velocity_m_s), seconds, seconds);
  add_occlusion_noise(expected.covariance, k_rotation, expected.angular_velocity_rad_s,
                      k_angular_occlusion_share_1_s, seconds, seconds);
  MeasuredPoint point{Vector3(0.02, 0, 0), Vector3::Zero(), 9e-8 * Matrix3::Identity()};
  point.measured_m = truth * point.model_m;
  (void)correct_by_point(expected, point);
  ASSERT_EQ(track.update(time, {&point, 1}), Reason::none);
  EXPECT_FALSE(track.at.is_static());
  const double size = expected.covariance.norm();
  EXPECT_LT((track.estimate().covariance - expected.covariance).norm(), 1e-9 * size);
  EXPECT_LT((track.estimate().pose.translation - expected.pose.translation).norm(), 1e-12);
}

// The same track with its sums stored outside.
TEST(TrackAtRest, IsThatOfTheToolMotionThatOwnsItsSums) {
  Random random(11);
  Track track;
  const auto motion = std::make_unique<ToolMotion>();
  const Pose truth{random.rotation(), random.vector(0.3)};
  CorrelatedErrors correlated;
  correlated.fast = 1e-9 * Matrix6::Identity();
  EXPECT_FALSE(motion->known());
  for (int frame = 0; frame < 40; ++frame) {
    const UncertainPose measured = seen(truth, test::frame_time(frame), random);
    ASSERT_EQ(motion->update(measured, correlated), Reason::none);
    ASSERT_EQ(track.at.update(measured, correlated, track.settings, *track.sums).reason,
              Reason::none);
    EXPECT_TRUE(motion->known());
    EXPECT_EQ(motion->is_static(), track.at.is_static());
    EXPECT_EQ(motion->estimate().covariance, track.estimate().covariance);
    EXPECT_EQ(motion->noise_scale().linear, track.at.noise_scale().linear);
    EXPECT_EQ(motion->noise_scale().angular, track.at.noise_scale().angular);
    EXPECT_EQ(motion->last_correction().nis, track.at.last_correction().nis);
    EXPECT_EQ(motion->correlated_covariance(), track.at.correlated_covariance(*track.sums));
  }
  EXPECT_TRUE(motion->is_static());
  EXPECT_EQ(motion->update(seen(truth, test::frame_time(39), random)), Reason::frame_duplicate);
}

// move() transforms a motion with its frame, static or not.
TEST(TrackAtRest, MovesWithItsFrame) {
  for (const bool rests : {false, true}) {
    Random random(10);
    Track track;
    Pose truth{random.rotation(), random.vector(0.3)};
    for (int frame = 0; frame < 40; ++frame) {
      if (!rests) truth.translation += Vector3(0.01, 0, 0);
      ASSERT_EQ(track.update(seen(truth, test::frame_time(frame), random)), Reason::none);
    }
    ASSERT_EQ(track.at.is_static(), rests);
    const MotionState before = track.estimate();
    const Pose by{from_rotation_vector({0.001, 0.002, -0.003}), {0.01, 0.02, 0.03}};
    track.at.move(by);
    const MotionState after = track.estimate();
    EXPECT_LT(pose_difference(after.pose, by * before.pose).norm(), rests ? 1e-4 : 1e-12);
    EXPECT_EQ(after.time, before.time);
    if (rests) continue;
    EXPECT_LT((after.covariance - transformed_state(before, by).covariance).norm(), 1e-15);
    EXPECT_EQ(after.velocity_m_s, Vector3(transformed_state(before, by).velocity_m_s));
  }
}
}  // namespace
}  // namespace glint::track_limits_test
