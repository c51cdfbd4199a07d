#include "platform/tools/calibrate/spin.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "expect_message.hpp"
#include "pivot_poses.hpp"

namespace glint {
namespace {

const Vector3 k_axis = Vector3(0.05, -0.08, 1).normalized();
const Vector3 k_foot(0.004, -0.003, -0.00044);  // across the axis

// Poses of a tool that rolls by a full turn in both directions and slides along its axis.
std::vector<TimedPose> rolled_poses(int count, double noise_rad,
                                    double turn_rad = 2 * std::numbers::pi,
                                    std::uint64_t seed = 1) {
  const sim::RandomKey key{seed, sim::Stream::hand, 3};
  const Quaternion held = from_rotation_vector({0.4, 0.7, -0.2});
  std::vector<TimedPose> poses;
  for (int i = 0; i < count; ++i) {
    const auto index = static_cast<std::uint64_t>(i);
    const double angle = turn_rad * (sim::uniform(key, index) - 0.5);
    const Quaternion rotation = held * from_rotation_vector(angle * k_axis);
    const Vector3 slid = held * k_axis * (0.02 * std::sin(0.1 * i));
    const Quaternion measured =
        (rotation * from_rotation_vector(noise_rad * sim::gaussian_vector(key, 1000 + index)))
            .normalized();
    poses.push_back({Time{std::int64_t{22'000'000} * i},
                     {measured, Vector3(0.1, 0.2, 0.6) + slid - rotation * k_foot}});
  }
  return poses;
}

double angle_between(const Vector3& a, const Vector3& b) { return a.cross(b).norm(); }

TEST(Spin, FindsTheAxisAndItsFootOfExactPoses) {
  const SpinResult result = calibrate_spin(rolled_poses(60, 0), {}, "exact");
  EXPECT_LT(angle_between(result.axis, k_axis), 1e-9);
  EXPECT_GT(result.axis.dot(k_axis), 0);
  const Vector3 foot = k_foot - k_axis * k_axis.dot(k_foot);
  EXPECT_LT((result.foot_m - foot).norm(), 1e-8);
  EXPECT_LT(result.foot_rms_m, 1e-9);
}

// The mean NEES of 60 runs, 2 degrees of freedom, is 2 +- 0.9.
TEST(Spin, KnowsHowSureItIs) {
  double sum = 0;
  constexpr int k_runs = 60;
  for (int run = 0; run < k_runs; ++run) {
    const SpinResult result = calibrate_spin(
        rolled_poses(150, 0.01, 2 * std::numbers::pi, static_cast<std::uint64_t>(run + 1)), {},
        "noise");
    const double off = angle_between(result.axis, k_axis);
    const Vector3 across = (k_axis - result.axis * result.axis.dot(k_axis)).normalized();
    sum += off * off / across.dot(result.axis_covariance_rad2 * across);
  }
  EXPECT_NEAR(sum / k_runs, 2.0, 0.9);
}

TEST(Spin, LeavesOutWildPoses) {
  std::vector<TimedPose> poses = rolled_poses(200, 0.003);
  for (std::size_t i = 0; i < poses.size(); i += 6) {
    poses[i].pose.rotation = from_rotation_vector({1, 0.3 * static_cast<double>(i % 5), 0.2});
  }
  const SpinResult result = calibrate_spin(poses, {}, "wild");
  EXPECT_GE(result.outliers, 34);
  EXPECT_LT(angle_between(result.axis, k_axis), 4 * result.axis_sigma_rad);
}

TEST(Spin, StopsAsSoonAsTheAxisIsKnownWellEnough) {
  SpinSettings settings;
  settings.stop_sigma_rad = 0.001;
  const SpinResult result = calibrate_spin(rolled_poses(3000, 0.01), settings, "stops");
  EXPECT_TRUE(result.sigma_reached);
  EXPECT_LT(result.poses_used, 600);
}

TEST(Spin, RefusesATurnThatIsTooSmallOrAboutManyAxes) {
  test::expect_input_error(
      [] { (void)calibrate_spin(rolled_poses(100, 0.001, 0.3), {}, "small.tum"); },
      {"small.tum", "turned by only", "roll it"});
  test::expect_input_error(
      [] {
        (void)calibrate_spin(test::pivot_poses({.tilt_rms_rad = {0.5, 0.5, 0.5}}, 100), {},
                             "all.tum");
      },
      {"all.tum", "no direction", "one axis only"});
  test::expect_input_error([] { (void)calibrate_spin(rolled_poses(5, 0), {}, "few.tum"); },
                           {"5 poses", "at least 12"});
}

}  // namespace
}  // namespace glint
