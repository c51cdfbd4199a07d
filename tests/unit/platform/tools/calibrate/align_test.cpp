#include "platform/tools/calibrate/align.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "expect_message.hpp"
#include "platform/sim/random.hpp"

namespace glint {
namespace {

const Pose k_x{from_rotation_vector({0.4, -1.1, 2.0}), {1.2, -0.3, 0.8}};
const Pose k_y{from_rotation_vector({-0.2, 0.9, 0.3}), {0.03, -0.05, 0.12}};
constexpr double k_offset_s = 0.0837;

struct Movement {
  Vector3 turn_rad{0.4, 0.5, 0.3};  // amplitude about each axis
  Vector3 shift_m{0.1, 0.08, 0.05};
  double position_noise_m = 0;
  double rotation_noise_rad = 0;
  Pose y = k_y;
  std::uint64_t seed = 1;
};

Pose moved(const Movement& how, double t) {
  const Vector3 turn(std::sin(2.1 * t), std::sin(1.3 * t + 1), std::cos(2.9 * t));
  const Vector3 shift(std::sin(1.7 * t), std::cos(2.3 * t), std::sin(0.9 * t));
  return {from_rotation_vector(how.turn_rad.cwiseProduct(turn)),
          how.shift_m.cwiseProduct(shift) + Vector3(0, 0, 0.5)};
}

TimedPose noisy(const Movement& how, double t, const Pose& pose, std::uint64_t which,
                std::uint64_t index) {
  const sim::RandomKey key{how.seed, sim::Stream::reference, which};
  const Quaternion off =
      from_rotation_vector(how.rotation_noise_rad * sim::gaussian_vector(key, index));
  const Vector3 by = how.position_noise_m * sim::gaussian_vector(key, 100'000 + index);
  return {Time{static_cast<std::int64_t>(std::llround(1e9 * t))},
          {(pose.rotation * off).normalized(), pose.translation + by}};
}

std::vector<TimedPose> own_series(const Movement& how, int count = 450) {
  std::vector<TimedPose> poses;
  for (int i = 0; i < count; ++i) {
    const double t = 1 + i / 45.0;
    poses.push_back(noisy(how, t, moved(how, t), 0, static_cast<std::uint64_t>(i)));
  }
  return poses;
}

// Reference poses at 100 Hz, with time stamps ahead by k_offset_s.
std::vector<TimedPose> reference_series(const Movement& how) {
  std::vector<TimedPose> poses;
  for (int i = 0; i < 1200; ++i) {
    const double t = i / 100.0;
    poses.push_back(
        noisy(how, t + k_offset_s, k_x * moved(how, t) * how.y, 1, static_cast<std::uint64_t>(i)));
  }
  return poses;
}

TEST(Align, FindsFrameLeverArmAndOffsetOfExactSeries) {
  const Movement how;
  const AlignResult found = align_series(own_series(how), reference_series(how), {}, "exact");
  EXPECT_NEAR(found.offset_s, k_offset_s, 1e-5);
  EXPECT_LT((found.T_reference_file.translation - k_x.translation).norm(), 1e-5);
  EXPECT_LT(found.T_reference_file.rotation.angularDistance(k_x.rotation), 1e-4);
  EXPECT_LT((found.T_tool_body.translation - k_y.translation).norm(), 1e-5);
  EXPECT_LT(found.T_tool_body.rotation.angularDistance(k_y.rotation), 1e-4);
}

// The mean NEES of the time offset over 20 runs is 1 +- 0.7.
TEST(Align, KnowsHowSureItIs) {
  double offset = 0, lever = 0;
  constexpr int k_runs = 20;
  for (int run = 0; run < k_runs; ++run) {
    const Movement how{.position_noise_m = 0.0005,
                       .rotation_noise_rad = 0.005,
                       .seed = static_cast<std::uint64_t>(run + 1)};
    const AlignResult found = align_series(own_series(how), reference_series(how), {}, "noise");
    offset += std::pow((found.offset_s - k_offset_s) / found.offset_sigma_s, 2) / k_runs;
    lever +=
        std::pow((found.T_tool_body.translation - k_y.translation).norm() / found.lever_sigma_m,
                 2) /
        k_runs;
  }
  EXPECT_NEAR(offset, 1, 0.7);
  EXPECT_GT(lever, 0.8);  // lever_sigma_m is the largest of three axes: NEES between 1 and 3
  EXPECT_LT(lever, 3.5);
}

TEST(Align, LeavesOutWildPoses) {
  const Movement how{.position_noise_m = 0.0005, .rotation_noise_rad = 0.003};
  std::vector<TimedPose> poses = own_series(how);
  for (std::size_t i = 0; i < poses.size(); i += 5) {
    poses[i].pose.translation += Vector3(0.2, 0.1 * static_cast<double>(i % 3), -0.1);
    poses[i].pose.rotation = poses[i].pose.rotation * from_rotation_vector({0.5, 0, 0});
  }
  const AlignResult found = align_series(poses, reference_series(how), {}, "wild");
  EXPECT_GE(found.outliers, 90);
  EXPECT_LE(found.outliers, 96);
  EXPECT_NEAR(found.offset_s, k_offset_s, 0.002);
  EXPECT_LT((found.T_reference_file.translation - k_x.translation).norm(), 0.002);
}

TEST(Align, NeedsNoTurnsWhereBothSeeOneFrame) {
  const Movement how{.turn_rad = {0, 0, 0.05}, .y = Pose{}};
  AlignSettings settings;
  settings.lever_arm = LeverArm::none;
  const AlignResult found =
      align_series(own_series(how), reference_series(how), settings, "one frame");
  EXPECT_NEAR(found.offset_s, k_offset_s, 1e-4);
  EXPECT_LT((found.T_reference_file.translation - k_x.translation).norm(), 1e-4);
}

TEST(Align, NamesWhatTooLittleMotionLeavesOpen) {
  const Movement about_one{.turn_rad = {0, 0, 0.6}};
  test::expect_input_error(
      [&] {
        (void)align_series(own_series(about_one), reference_series(about_one), {}, "one.tum");
      },
      {"one.tum", "1.00]", "lever arm along it is not observable", "two axes"});
  const Movement still{.turn_rad = {0, 0, 0},
                       .shift_m = {0, 0, 0},
                       .position_noise_m = 0.001,
                       .rotation_noise_rad = 0.005,
                       .y = Pose{}};
  AlignSettings settings;
  settings.lever_arm = LeverArm::none;
  test::expect_input_error(
      [&] {
        (void)align_series(own_series(still), reference_series(still), settings, "still.tum");
      },
      {"still.tum", "time offset is not observable", "to and fro"});
}

TEST(Align, RefusesSeriesThatDoNotOverlapOrBelongTogether) {
  const Movement how;
  std::vector<TimedPose> later = own_series(how);
  for (TimedPose& pose : later) pose.time = pose.time + milliseconds(60'000);
  test::expect_input_error(
      [&] { (void)align_series(later, reference_series(how), {}, "late.tum"); },
      {"late.tum", "overlap"});
}

}  // namespace
}  // namespace glint
