#include "kernels/registration/follow_reference.hpp"

#include <gtest/gtest.h>

#include "platform/dense.hpp"
#include "tests/unit/heap_count.hpp"
#include "tests/unit/kernels/registration/tracked_arm_scene.hpp"

namespace glint::follow_reference_test {
namespace {

using test::at;
using test::k_truth;
using test::k_world_pixels;
using test::TrackedArmScene;

Vector6 error_of(const Pose& found, const Pose& truth) {
  Vector6 error;
  const Quaternion q = found.rotation * truth.rotation.conjugate();
  error << found.translation - truth.translation, 2 * q.vec() * (q.w() < 0 ? -1 : 1);
  return error;
}

TEST(FollowReference, FollowsADriftWithinItsCovariance) {
  TrackedArmScene world;
  double squares = 0, worst_mm = 0;
  int judged = 0;
  for (int i = 1; i <= 40; ++i) {
    const double t = 0.5 * i;  // two images a second; drift 1 mm/s and 0.03 deg/s
    const Pose truth{
        (Quaternion(Eigen::AngleAxisd(5e-4 * t, Vector3::UnitZ())) * k_truth.rotation).normalized(),
        k_truth.translation + 1e-3 * t * Vector3(0.6, 0, 0.8)};
    world.draw(truth);
    world.look(at(t));
    ASSERT_EQ(world.follower.report().outcome, FollowOutcome::followed) << i;
    if (t < 3 * world.follower.settings.time_constant_s) continue;
    const FollowedReference now = world.follower.reference(at(t));
    const Vector6 error = error_of(now.T_world_base, truth);
    const Matrix6 inverse = inverse_of(now.covariance);
    squares += error.dot(inverse * error) / 6;
    worst_mm = std::max(worst_mm, 1e3 * error.head<3>().norm());
    ++judged;
  }
  EXPECT_LT(squares / judged, 1.5);
  EXPECT_GT(squares / judged, 0.05);  // not overly conservative
  EXPECT_LT(worst_mm, 5);             // of 20 mm of drift
  EXPECT_GT(worst_mm, 0.5);           // the low-pass lags, as stated
}

TEST(FollowReference, GoesAPartOfTheWayByItsTimeConstant) {
  TrackedArmScene world;
  const Pose truth{k_truth.rotation, k_truth.translation + Vector3(0.01, 0, 0)};
  world.draw(truth);
  world.look(at(world.follower.settings.time_constant_s));
  ASSERT_EQ(world.follower.report().outcome, FollowOutcome::followed);
  const Pose seen = world.follower.report().seen.T_world_base;
  const Vector3 left = world.follower.reference(at(2)).T_world_base.translation - seen.translation;
  EXPECT_NEAR(left.norm() / (k_truth.translation - seen.translation).norm(), std::exp(-1), 0.01);
  EXPECT_LT(left.norm(), 0.01);
}

TEST(FollowReference, RefusesAJumpAndTellsIt) {
  TrackedArmScene world;
  world.draw({k_truth.rotation, k_truth.translation + Vector3(0.03, 0, 0)});
  for (int i = 1; i <= 3; ++i) {
    world.look(at(i));
    const FollowReport& report = world.follower.report();
    EXPECT_EQ(report.outcome, FollowOutcome::jumped) << name_of(report.outcome);
    EXPECT_NEAR(report.shift_m, 0.03, 0.004);
    EXPECT_EQ(report.jumps, i);
  }
  EXPECT_EQ(world.follower.reference(at(3)).T_world_base.translation, k_truth.translation);
  EXPECT_EQ(world.follower.reference(at(3)).measured, at(0));
  // Back at the reference pose, it is followed again.
  world.draw(k_truth);
  world.look(at(4));
  EXPECT_EQ(world.follower.report().outcome, FollowOutcome::followed);
  EXPECT_EQ(world.follower.report().jumps, 0);
  // A rotation in place is a jump as well.
  world.draw({(Quaternion(Eigen::AngleAxisd(0.06, Vector3::UnitY())) * k_truth.rotation),
              k_truth.translation});
  world.look(at(5));
  EXPECT_EQ(world.follower.report().outcome, FollowOutcome::jumped);
}

TEST(FollowReference, LeavesAHiddenRobotAloneAndKnowsLessOfItAsTimePasses) {
  TrackedArmScene world;
  const FollowedReference before = world.follower.reference(at(1));
  std::fill(world.depth.begin(), world.depth.end(), 0.5f);
  world.look(at(5));
  EXPECT_EQ(world.follower.report().outcome, FollowOutcome::hidden);
  std::fill(world.depth.begin(), world.depth.end(), 0.0f);
  world.look(at(9));
  EXPECT_EQ(world.follower.report().outcome, FollowOutcome::hidden);
  std::fill(world.depth.begin(), world.depth.end(), std::nanf(""));
  world.look(at(10));
  EXPECT_EQ(world.follower.report().outcome, FollowOutcome::hidden);
  const FollowedReference after = world.follower.reference(at(10));
  EXPECT_EQ(after.T_world_base.translation, before.T_world_base.translation);
  EXPECT_EQ(after.T_world_base.rotation.coeffs(), before.T_world_base.rotation.coeffs());
  const auto spread = [](const FollowedReference& r) { return std::sqrt(r.covariance(0, 0)); };
  EXPECT_NEAR(spread(after) - spread(before), 0.009, 0.001);  // 9 s at 1 mm/s
}

TEST(FollowReference, IsNotTakenInByARobotThatIsGone) {
  TrackedArmScene world;
  std::fill(world.depth.begin(), world.depth.end(), 1.9f);
  world.look(at(1));
  EXPECT_NE(world.follower.report().outcome, FollowOutcome::followed);
  EXPECT_EQ(world.follower.reference(at(1)).T_world_base.translation, k_truth.translation);
}

// The limit is 3 sqrt(trace) of the position's, or the rotation's, covariance.
TEST(FollowReference, IsUnsureWhereAJumpCouldBeNoise) {
  const auto outcome = [](double jump_m, double jump_rad, Matrix6& covariance) {
    TrackedArmScene world;
    world.draw(k_truth);
    if (jump_m > 0) world.follower.settings.jump_m = jump_m;
    if (jump_rad > 0) world.follower.settings.jump_rad = jump_rad;
    world.look(at(1));
    covariance = world.follower.report().seen.covariance;
    return world.follower.report().outcome;
  };
  Matrix6 seen, again;
  ASSERT_EQ(outcome(0, 0, seen), FollowOutcome::followed);
  const double shift = 3 * std::sqrt(seen.topLeftCorner<3, 3>().trace());
  const double turn = 3 * std::sqrt(seen.bottomRightCorner<3, 3>().trace());
  EXPECT_EQ(outcome(0.99 * shift, 0, again), FollowOutcome::unsure);
  EXPECT_NE(outcome(1.01 * shift, 0, again), FollowOutcome::unsure);
  EXPECT_EQ(outcome(0, 0.99 * turn, again), FollowOutcome::unsure);
  EXPECT_NE(outcome(0, 1.01 * turn, again), FollowOutcome::unsure);
  EXPECT_EQ(again, seen);
}

TEST(FollowReference, WantsAReferenceAndNewerPictures) {
  TrackedArmScene world;
  world.draw(k_truth);
  world.look(at(2));
  EXPECT_EQ(world.look(at(2)), 0);
  EXPECT_EQ(world.follower.report().outcome, FollowOutcome::late);
  RobotPoseTracker none;
  EXPECT_EQ(none.prepare(0, 64), Reason::out_of_range);
  ASSERT_EQ(none.prepare(k_world_pixels, 64), Reason::none);
  EXPECT_FALSE(none.look(world.view(), at(1)));
  EXPECT_EQ(none.report().outcome, FollowOutcome::no_reference);
  EXPECT_FALSE(none.step());
  none.settings.time_constant_s = 0;
  EXPECT_EQ(none.prepare(k_world_pixels, 64), Reason::out_of_range);
}

TEST(FollowReference, LeavesAPictureUnfinishedWhenANewReferenceComes) {
  TrackedArmScene world;
  world.draw({k_truth.rotation, k_truth.translation + Vector3(0.004, 0, 0)});
  ASSERT_TRUE(world.follower.look(world.view(), at(1)));
  ASSERT_TRUE(world.follower.step());
  world.follower.begin(k_truth, Matrix6::Identity() * 1e-6, at(2));
  EXPECT_TRUE(world.follower.idle());
  EXPECT_FALSE(world.follower.step());
  EXPECT_EQ(world.follower.reference(at(2)).T_world_base.translation, k_truth.translation);
}

TEST(FollowReference, TakesNoMoreSlicesThanItSaysAndNoHeap) {
  TrackedArmScene world;
  world.follower.settings.alignment.convergence_translation_m = 0;  // never converges
  world.draw({k_truth.rotation, k_truth.translation + Vector3(0.004, 0, 0)});
  EXPECT_EQ(world.look(at(1)), world.follower.slices_max());
  const HeapCount heap;
  world.look(at(2));
  EXPECT_EQ(heap.count(), 0u);
}

}  // namespace
}  // namespace glint::follow_reference_test
