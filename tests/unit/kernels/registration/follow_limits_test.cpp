// Robot tracking: each limit that decides whether an alignment is accepted, and the update's size.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "tests/unit/kernels/registration/tracked_arm_scene.hpp"

namespace glint::follow_limits_test {
namespace {

using test::at;
using test::k_truth;
using test::k_world_pixels;
using test::TrackedArmScene;

// 12 mm aside, rotated by 0.02 rad, one of 40 pixels seen through: all within the limits.
FollowReport report_of(const FollowSettings& settings) {
  TrackedArmScene world;
  world.follower.settings = settings;
  world.draw({(Quaternion(Eigen::AngleAxisd(0.02, Vector3::UnitY())) * k_truth.rotation),
              k_truth.translation + Vector3(0.012, 0, 0)});
  int model_pixels = 0;
  for (float& z : world.depth) {
    if (z < 1.8f && ++model_pixels % 40 == 0) z = 1.9f;
  }
  world.look(at(1));
  return world.follower.report();
}

TEST(FollowLimits, DecideEachAlone) {
  const FollowReport first = report_of({});
  ASSERT_EQ(first.outcome, FollowOutcome::followed) << name_of(first.outcome);
  const AlignmentScore& judged = first.judgement;
  ASSERT_GT(judged.unhidden_seen_through_share(), 0);
  ASSERT_GT(first.turn_rad, 0.01);
  const auto outcome = [](double FollowSettings::*limit, double value) {
    FollowSettings settings;
    settings.*limit = value;
    return report_of(settings).outcome;
  };
  using S = FollowSettings;
  const struct {
    double S::*limit;
    double value;
    bool is_max;
    FollowOutcome beyond;
  } cases[] = {{&S::visible_share_min, judged.visible_share(), false, FollowOutcome::hidden},
               {&S::inlier_share_min, judged.inlier_share(), false, FollowOutcome::unexplained},
               {&S::seen_through_share_max, judged.unhidden_seen_through_share(), true,
                FollowOutcome::unexplained},
               {&S::jump_m, first.shift_m, true, FollowOutcome::jumped},
               {&S::jump_rad, first.turn_rad, true, FollowOutcome::jumped}};
  for (const auto& c : cases) {
    const double beyond = std::nextafter(c.value, c.is_max ? -9.0 : 9.0);
    EXPECT_EQ(outcome(c.limit, c.value), FollowOutcome::followed) << name_of(c.beyond);
    EXPECT_EQ(outcome(c.limit, beyond), c.beyond) << name_of(outcome(c.limit, beyond));
  }
}

// The rotation is between both orientations; the translation is that of the visible centroid.
TEST(FollowLimits, MeasureTheTurnAndTheShiftOfTheMiddle) {
  for (const double sign : {1.0, -1.0}) {  // q and -q are the same rotation
    TrackedArmScene world;
    Vector3 centroid = Vector3::Zero();
    world.draw(k_truth);
    int seen = 0;
    for (int i = 0; i < k_world_pixels; ++i) {
      const float z = world.depth[static_cast<std::size_t>(i)];
      if (z > 1.8f) continue;
      centroid += pixel_point(world.camera, i % 160, i / 160, z).cast<double>();
      ++seen;
    }
    centroid /= seen;
    Quaternion start = k_truth.rotation;
    start.coeffs() *= sign;
    world.follower.begin({start, k_truth.translation}, Matrix6::Identity() * 1e-6, at(0));
    const Quaternion turn(Eigen::AngleAxisd(0.025, Vector3::UnitZ()));
    const Pose truth{(turn * k_truth.rotation).normalized(),
                     centroid + turn * (k_truth.translation - centroid)};
    world.draw(truth);
    world.look(at(1));
    const FollowReport& report = world.follower.report();
    ASSERT_EQ(report.outcome, FollowOutcome::followed) << name_of(report.outcome);
    EXPECT_NEAR(report.turn_rad, report.seen.T_world_base.rotation.angularDistance(start), 1e-7);
    EXPECT_NEAR(report.turn_rad, 0.025, 0.005);
    EXPECT_LT(report.shift_m, 0.003);
    EXPECT_GT((truth.translation - k_truth.translation).norm(), 0.004);
  }
}

// By the fraction 1 - exp(-dt / time constant) of the rotation; the covariance likewise.
TEST(FollowReference, GoesThatPartOfTurnAndCovarianceToo) {
  for (const double seconds : {0.3, 2.0, 1e4}) {
    TrackedArmScene world;
    const FollowedReference before = world.follower.reference(at(0));
    world.draw({(Quaternion(Eigen::AngleAxisd(0.02, Vector3::UnitY())) * k_truth.rotation),
                k_truth.translation + Vector3(0.01, 0, 0)});
    world.look(at(seconds));
    const FollowReport& report = world.follower.report();
    ASSERT_EQ(report.outcome, FollowOutcome::followed);
    const double gain = 1 - std::exp(-seconds / 2);
    const FollowedReference after = world.follower.reference(at(seconds));
    EXPECT_EQ(after.measured, at(seconds));
    const Quaternion expected = k_truth.rotation.slerp(gain, report.seen.T_world_base.rotation);
    EXPECT_LT(after.T_world_base.rotation.angularDistance(expected), 1e-7);
    // The declared drift contributes the same at both times.
    const Matrix6 mixed =
        (1 - gain) * (1 - gain) * 1e-6 * Matrix6::Identity() + gain * gain * report.seen.covariance;
    const Matrix6 drifted = before.covariance - 1e-6 * Matrix6::Identity();
    EXPECT_LT((after.covariance - drifted - mixed).norm(), 1e-12 * mixed.norm() + 1e-18);
    if (seconds > 100) {
      EXPECT_LT((after.T_world_base.translation - report.seen.T_world_base.translation).norm(),
                1e-12);
    }
  }
}

TEST(FollowReference, StatesWhatTheDeclaredDriftMayHaveDone) {
  TrackedArmScene world;
  world.follower.settings.time_constant_s = 1.5;
  world.follower.settings.drift_m_s = 2e-3;
  world.follower.settings.drift_rad_s = 3e-3;
  Matrix6 covariance = Matrix6::Random();
  covariance = 1e-6 * covariance * covariance.transpose();
  world.follower.begin(k_truth, covariance, at(10));
  for (const double now : {10.0, 14.0, 3.0}) {
    const double late = 1.5 + std::max(now - 10, 0.0);
    Matrix6 expected = covariance;
    for (int i = 0; i < 6; ++i) {
      const double off = (i < 3 ? 2e-3 : 3e-3) * late;
      expected(i, i) += off * off;
    }
    const FollowedReference reference = world.follower.reference(at(now));
    EXPECT_LT((reference.covariance - expected).norm(), 1e-15) << now;
    EXPECT_EQ(reference.T_world_base.translation, k_truth.translation);
    EXPECT_EQ(reference.measured, at(10));
  }
}

TEST(FollowReference, BegunAnewOrPreparedAnewHasNothingOfTheLastReference) {
  TrackedArmScene world;
  world.draw({k_truth.rotation, k_truth.translation + Vector3(0.03, 0, 0)});
  world.look(at(1));
  world.look(at(2));
  EXPECT_EQ(world.follower.report().jumps, 2);
  const Pose other{k_truth.rotation, Vector3(1, 2, 3)};
  world.follower.begin(other, Matrix6::Identity(), at(5));
  EXPECT_EQ(world.follower.report().jumps, 0);
  EXPECT_EQ(world.follower.report().outcome, FollowOutcome::followed);
  EXPECT_EQ(world.follower.report().time, at(5));
  EXPECT_EQ(world.follower.report().shift_m, 0);
  EXPECT_EQ(world.follower.reference(at(5)).T_world_base.translation, Vector3(1, 2, 3));
  EXPECT_EQ(world.look(at(5)), 0) << "not newer than the reference";
  EXPECT_EQ(world.follower.report().outcome, FollowOutcome::late);
  EXPECT_EQ(world.follower.report().time, at(5));
  EXPECT_GT(world.look(at(5.01)), 0);
  EXPECT_EQ(world.look(at(5.01)), 0) << "not newer than the last picture";
  ASSERT_TRUE(world.follower.look(world.view(), at(6)));
  ASSERT_EQ(world.follower.prepare(k_world_pixels, 64), Reason::none);
  EXPECT_TRUE(world.follower.idle());
  EXPECT_FALSE(world.follower.look(world.view(), at(7)));
  EXPECT_EQ(world.follower.report().outcome, FollowOutcome::no_reference);
  EXPECT_EQ(world.follower.report().time, at(7));
}

TEST(FollowReference, TakesEachSettingAtItsLimitAndRefusesItBeyond) {
  const auto reason_of = [](double FollowSettings::*setting, double value) {
    RobotPoseTracker follower;
    follower.settings.*setting = value;
    return follower.prepare(100, 8);
  };
  using S = FollowSettings;
  constexpr double k_nan = std::numeric_limits<double>::quiet_NaN();
  constexpr double k_infinity = std::numeric_limits<double>::infinity();
  for (double S::*setting : {&S::time_constant_s, &S::jump_m, &S::jump_rad}) {
    EXPECT_EQ(reason_of(setting, 1e-9), Reason::none);
    for (const double wrong : {0.0, -1.0, k_nan, k_infinity}) {
      EXPECT_EQ(reason_of(setting, wrong), Reason::out_of_range) << wrong;
    }
  }
  for (double S::*setting : {&S::drift_m_s, &S::drift_rad_s}) {
    EXPECT_EQ(reason_of(setting, 0), Reason::none);
    for (const double wrong : {-1e-9, k_nan}) {
      EXPECT_EQ(reason_of(setting, wrong), Reason::out_of_range) << wrong;
    }
  }
  RobotPoseTracker follower;
  EXPECT_EQ(follower.prepare(1, 1), Reason::none);
  EXPECT_EQ(follower.prepare(0, 8), Reason::out_of_range);
  EXPECT_EQ(follower.prepare(100, 0), Reason::out_of_range);
  EXPECT_EQ(follower.prepare(k_scene_pixels_max + 1, 8), Reason::out_of_range);
}

TEST(FollowReference, TakesStepsForEachCallAndNoneWithoutAPicture) {
  TrackedArmScene world;
  EXPECT_EQ(world.follower.step(1), 0);
  world.draw(k_truth);
  for (const int steps : {1, 0, -5}) {
    ASSERT_TRUE(world.follower.look(world.view(), at(2 - 0.1 * steps)));
    int calls = 0;
    for (; !world.follower.idle(); ++calls) ASSERT_GE(world.follower.step(steps), 100);
    EXPECT_GT(calls, k_world_pixels) << "a slice of one step does one thing";
    EXPECT_EQ(world.follower.step(steps), 0);
    EXPECT_EQ(world.follower.report().outcome, FollowOutcome::followed);
  }
}

// Until its steps are used up or the image is complete.
TEST(FollowReference, GoesOnUntilItsStepsAreUsedUp) {
  TrackedArmScene world;
  world.draw(k_truth);
  for (const int steps : {5'000, 100'000, 1 << 29}) {
    ASSERT_TRUE(world.follower.look(world.view(), at(1 + 1e-9 * steps)));
    int calls = 0;
    for (; !world.follower.idle(); ++calls) {
      const int taken = world.follower.step(steps);
      ASSERT_TRUE(taken >= steps || world.follower.idle()) << taken;
    }
    EXPECT_EQ(calls == 1, steps == 1 << 29);
  }
}

TEST(FollowOutcome, EachHasANameOfItsOwn) {
  EXPECT_STREQ(name_of(FollowOutcome::followed), "followed");
  EXPECT_STREQ(name_of(FollowOutcome::no_reference), "no_reference");
  EXPECT_STREQ(name_of(FollowOutcome::late), "late");
  EXPECT_STREQ(name_of(FollowOutcome::hidden), "hidden");
  EXPECT_STREQ(name_of(FollowOutcome::unexplained), "unexplained");
  EXPECT_STREQ(name_of(FollowOutcome::unsure), "unsure");
  EXPECT_STREQ(name_of(FollowOutcome::jumped), "jumped");
}

}  // namespace
}  // namespace glint::follow_limits_test
