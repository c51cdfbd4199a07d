#include "platform/tools/calibrate/pivot.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "expect_message.hpp"
#include "pivot_poses.hpp"

namespace glint {
namespace {

using test::pivot_poses;
using test::PivotMotion;

TEST(Pivot, FindsTheTipOfExactPoses) {
  const PivotMotion turn;
  const PivotResult result = calibrate_pivot(pivot_poses(turn, 50), {}, "exact");
  EXPECT_LT((result.tip_m - turn.tip_m).norm(), 1e-9);
  EXPECT_LT((result.post_m - turn.post_m).norm(), 1e-9);
  EXPECT_EQ(result.outliers, 0);
}

TEST(Pivot, LeavesOutWildPoses) {
  const PivotMotion turn{.position_sigma_m = 0.0003, .rotation_sigma_rad = 0.002};
  std::vector<TimedPose> poses = pivot_poses(turn, 300);
  for (std::size_t i = 0; i < poses.size(); i += 5) {  // every fifth pose is of another object
    poses[i].pose.translation += Vector3(0.3, -0.1, 0.02 * static_cast<double>(i % 7));
  }
  const PivotResult result = calibrate_pivot(poses, {}, "wild");
  EXPECT_GE(result.outliers, 60);
  EXPECT_LE(result.outliers, 64);
  EXPECT_LT((result.tip_m - turn.tip_m).norm(), 4 * result.tip_sigma_m);
  EXPECT_LT(result.tip_sigma_m, 0.0003);
}

// The mean NEES of 60 runs, 3 degrees of freedom, is 3 +- 1.
TEST(Pivot, KnowsHowSureItIs) {
  double sum = 0;
  constexpr int k_runs = 60;
  for (int run = 0; run < k_runs; ++run) {
    const PivotMotion turn{.position_sigma_m = 0.0005,
                           .rotation_sigma_rad = 0.006,
                           .seed = static_cast<std::uint64_t>(run + 1)};
    const PivotResult result = calibrate_pivot(pivot_poses(turn, 200), {}, "noise");
    const Vector3 off = result.tip_m - turn.tip_m;
    sum += off.dot(result.tip_covariance_m2.inverse() * off);
  }
  EXPECT_NEAR(sum / k_runs, 3.0, 1.0);
}

// A relative scale error of the positions moves the tip by the same part of its lever arm.
TEST(Pivot, CountsAScaleAlongTheArm) {
  const PivotMotion turn;
  PivotSettings settings;
  const PivotResult exact = calibrate_pivot(pivot_poses(turn, 200), settings, "exact");
  settings.scale_sigma = 0.01;
  const PivotResult scaled = calibrate_pivot(pivot_poses(turn, 200), settings, "scaled");
  const Vector3 arm = exact.tip_m - settings.centre_m;
  const Matrix3 more = scaled.tip_covariance_m2 - exact.tip_covariance_m2;
  EXPECT_NEAR(arm.normalized().dot(more * arm.normalized()), 1e-4 * arm.squaredNorm(), 1e-9);
  EXPECT_NEAR(more.trace(), 1e-4 * arm.squaredNorm(), 1e-9);
}

TEST(Pivot, IsNotDrawnTowardsTheCentreByNoisyRotations) {
  Vector3 mean = Vector3::Zero();
  constexpr int k_runs = 40;
  PivotMotion turn{
      .tilt_rms_rad = {0.2, 0.2, 0.2}, .position_sigma_m = 0.0005, .rotation_sigma_rad = 0.02};
  for (int run = 0; run < k_runs; ++run) {
    turn.seed = static_cast<std::uint64_t>(run + 1);
    mean += calibrate_pivot(pivot_poses(turn, 300), {}, "noise").tip_m / k_runs;
  }
  // Plain least squares is biased 1.5 mm towards the centre (0.02^2 / 0.2^2 of 155 mm).
  EXPECT_NEAR(mean.norm() - turn.tip_m.norm(), 0, 0.0004);
}

TEST(Pivot, TakesPosesThatRepeatForOne) {
  PivotMotion turn{.position_sigma_m = 0.0005, .rotation_sigma_rad = 0.004};
  const double once = calibrate_pivot(pivot_poses(turn, 200), {}, "once").tip_sigma_m;
  turn.repeats = 5;
  const double repeated = calibrate_pivot(pivot_poses(turn, 1000), {}, "repeated").tip_sigma_m;
  EXPECT_GT(repeated, 0.9 * once);
  EXPECT_LT(repeated, 2.0 * once);
}

TEST(Pivot, TrustsFewPosesAlikeButNotAWildOne) {
  const PivotMotion turn{.position_sigma_m = 0.0005, .rotation_sigma_rad = 0.002};
  std::vector<TimedPose> poses = pivot_poses(turn, 20);
  EXPECT_EQ(calibrate_pivot(poses, {}, "few").outliers, 0);
  poses[7].pose.translation.x() += 0.1;
  const PivotResult result = calibrate_pivot(poses, {}, "few");
  EXPECT_EQ(result.outliers, 1);
  EXPECT_FALSE(result.kept[7]);
  EXPECT_LT((result.tip_m - turn.tip_m).norm(), 0.002);
}

TEST(Pivot, StopsAsSoonAsTheTipIsKnownWellEnough) {
  const PivotMotion turn{.position_sigma_m = 0.0005, .rotation_sigma_rad = 0.002};
  PivotSettings settings;
  settings.stop_sigma_m = 0.0004;
  const PivotResult result = calibrate_pivot(pivot_poses(turn, 2000), settings, "stops");
  EXPECT_TRUE(result.sigma_reached);
  EXPECT_LT(result.poses_used, 500);
  EXPECT_LT(result.tip_sigma_m, 0.0004);
  settings.stop_sigma_m = 1e-7;
  EXPECT_FALSE(calibrate_pivot(pivot_poses(turn, 200), settings, "never").sigma_reached);
}

TEST(Pivot, NamesTheDirectionThatAToolTurnedAboutOneAxisLeavesOpen) {
  const PivotMotion turn{.tilt_rms_rad = {0, 0, 0.5}, .rotation_sigma_rad = 0.003};
  test::expect_input_error([&] { (void)calibrate_pivot(pivot_poses(turn, 200), {}, "one.tum"); },
                           {"one.tum", "1.00]", "is not observable", "tilt the tool"});
}

TEST(Pivot, RefusesTooFewPosesAndATipThatWanders) {
  const PivotMotion turn;
  test::expect_input_error([&] { (void)calibrate_pivot(pivot_poses(turn, 11), {}, "few.tum"); },
                           {"few.tum", "11 poses", "at least 12"});
  const PivotMotion wander{.position_sigma_m = 0.1};
  test::expect_input_error([&] { (void)calibrate_pivot(pivot_poses(wander, 100), {}, "far.tum"); },
                           {"far.tum", "at rest in a dent"});
}

}  // namespace
}  // namespace glint
