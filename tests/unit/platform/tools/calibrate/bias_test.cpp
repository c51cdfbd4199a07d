#include "platform/tools/calibrate/bias.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <fstream>

#include "expect_message.hpp"
#include "platform/cells/correction_text.hpp"
#include "platform/sim/random.hpp"
#include "platform/tools/calibrate/alignment_file.hpp"

namespace glint {
namespace {

const Vector3 k_shift_m{0.0012, -0.0008, 0.0021};
const Vector3 k_turn_rad{0.004, -0.006, 0.002};

// A tool that is static at several positions in turn, with measurement noise and a constant error.
// It moves for one second between two positions.
struct StaticScene {
  CorrectionFrame frame = CorrectionFrame::tool;
  Vector3 shift_m = k_shift_m, turn_rad = k_turn_rad;
  double position_noise_m = 0.0004, rotation_noise_rad = 0.003;
  int positions = 3;
  double speed_m_s = 0;  // constant drift, which leaves no static window
  std::uint64_t seed = 1;
};

Pose truth_at(const StaticScene& how, double t) {
  const double position =
      std::min(std::floor(t / 4) + std::max(0.0, std::fmod(t, 4.0) - 3), how.positions - 1.0);
  return {from_rotation_vector({0.3 + 0.2 * position, -0.5, 0.1}),
          {0.02 * position + how.speed_m_s * t, -0.05, 0.45 + 0.06 * position}};
}

std::vector<TimedPose> reference_of(const StaticScene& how) {
  std::vector<TimedPose> poses;
  for (int i = 0; i < 400 * how.positions; ++i) {
    poses.push_back({Time{} + milliseconds(10 * i), truth_at(how, 0.01 * i)});
  }
  return poses;
}

std::vector<TimedPose> measured_by(const StaticScene& how) {
  std::vector<TimedPose> poses;
  const sim::RandomKey shift{how.seed, sim::Stream::reference, 0};
  const sim::RandomKey turn{how.seed, sim::Stream::reference, 1};
  for (int i = 10; i < 180 * how.positions - 10; ++i) {
    const auto index = static_cast<std::uint64_t>(i);
    const Time time = Time{} + microseconds(22'222LL * i);
    Pose pose = truth_at(how, Duration{time.nanoseconds}.seconds());
    const Quaternion off = from_rotation_vector(how.turn_rad);
    if (how.frame == CorrectionFrame::tool) {
      pose = pose * Pose{off, how.shift_m}.inverse();
    } else {
      pose = {off.conjugate() * pose.rotation, pose.translation - how.shift_m};
    }
    pose.translation += how.position_noise_m * sim::gaussian_vector(shift, index);
    pose.rotation =
        (from_rotation_vector(how.rotation_noise_rad * sim::gaussian_vector(turn, index)) *
         pose.rotation)
            .normalized();
    poses.push_back({time, pose});
  }
  return poses;
}

BiasResult found_for(const StaticScene& how) {
  BiasSettings settings;
  settings.frame = how.frame;
  return calibrate_bias(measured_by(how), reference_of(how), settings, "still.tum");
}

TEST(Bias, FindsAConstantErrorAlongEitherFrame) {
  for (const auto frame : {CorrectionFrame::tool, CorrectionFrame::camera}) {
    const StaticScene how{.frame = frame};
    const BiasResult found = found_for(how);
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_NEAR(found.correction.translation_m[axis], k_shift_m[axis],
                  4 * found.translation_sigma_m[axis] + 1e-6);
      EXPECT_NEAR(found.correction.rotation_rad[axis], k_turn_rad[axis],
                  4 * found.rotation_sigma_rad[axis] + 1e-6);
    }
    EXPECT_LT(found.translation_sigma_m.maxCoeff(), 0.0001);
    EXPECT_GT(found.rms_before_m, 0.0024);
    EXPECT_LT(found.rms_after_m, 0.0008);
    EXPECT_LT(found.rms_after_rad, 0.7 * found.rms_before_rad);
  }
}

// The mean NEES of 60 runs, six components each, is 1 +- 0.25 (4.7 standard deviations).
TEST(Bias, KnowsHowSureItIs) {
  double sum = 0;
  constexpr int k_runs = 60;
  for (int run = 0; run < k_runs; ++run) {
    const StaticScene how{.seed = static_cast<std::uint64_t>(run + 1)};
    const BiasResult found = found_for(how);
    const Vector3 shift =
        (found.correction.translation_m - k_shift_m).cwiseQuotient(found.translation_sigma_m);
    const Vector3 turn =
        (found.correction.rotation_rad - k_turn_rad).cwiseQuotient(found.rotation_sigma_rad);
    sum += (shift.squaredNorm() + turn.squaredNorm()) / (6 * k_runs);
  }
  std::printf("bias: squared errors in sigmas %.2f\n", sum);
  EXPECT_NEAR(sum, 1, 0.25);
}

TEST(Bias, HoldsForWhatWasSeenAndLittleMore) {
  const BiasResult found = found_for({});
  const StaticScene how;
  double least = 1, most = 0;
  for (int position = 0; position < how.positions; ++position) {
    const double range = truth_at(how, 4.0 * position + 1).translation.norm();
    least = std::min(least, range);
    most = std::max(most, range);
  }
  EXPECT_NEAR(found.correction.range_m.from, least - 0.02, 0.005);
  EXPECT_NEAR(found.correction.range_m.to, most + 0.02, 0.005);
  EXPECT_EQ(correct_bias(found.correction, truth_at(how, 1)).reason, Reason::none);
  Pose near = truth_at(how, 1);
  near.translation *= 0.5;
  EXPECT_EQ(correct_bias(found.correction, near).reason, Reason::out_of_range);
  Pose turned = truth_at(how, 1);
  turned.rotation = turned.rotation * from_rotation_vector({1, 0, 0});
  EXPECT_EQ(correct_bias(found.correction, turned).reason, Reason::out_of_range);
}

TEST(Bias, LeavesOutMotionAndWildPoses) {
  const StaticScene how;
  std::vector<TimedPose> poses = measured_by(how);
  for (std::size_t i = 0; i < poses.size(); i += 5) poses[i].pose.translation.x() += 0.05;
  const BiasResult found = calibrate_bias(poses, reference_of(how), {}, "wild.tum");
  EXPECT_GE(found.moving, 80);
  EXPECT_NEAR(found.outliers, found.samples / 5, 5);
  EXPECT_LT((found.correction.translation_m - k_shift_m).norm(), 0.0002);
}

TEST(Bias, RefusesMotionTooFewPosesAndChance) {
  const StaticScene drifting{.speed_m_s = 0.05};
  test::expect_input_error([&] { (void)found_for(drifting); },
                           {"still.tum", "in motion", "hold camera and tool still"});
  const StaticScene how;
  const std::vector<TimedPose> poses = measured_by(how);
  test::expect_input_error(
      [&] { (void)calibrate_bias(std::span(poses).first(20), reference_of(how), {}, "few.tum"); },
      {"few.tum", "lie within the reference's time", "at least 30"});
  const StaticScene none{.shift_m = Vector3::Zero(), .turn_rad = Vector3::Zero(), .seed = 3};
  test::expect_input_error([&] { (void)found_for(none); }, {"too small to correct"});
}

TEST(Bias, SaysApartWhatIsCorrectedAndWhere) {
  BiasCorrection correction;
  EXPECT_EQ(correction_text(correction), "");
  correction.frame = CorrectionFrame::tool;
  correction.translation_m = {0.003, 0, 0.004};
  correction.range_m = {0.35, 0.65};
  correction.off_axis_cosine = {0.5, 1};
  correction.tilt_cosine = {-0.5, 0};
  EXPECT_EQ(correction_text(correction),
            "5.00 mm, 0.00 deg along the tool's axes, valid from 350 to 650 mm, 0 to 60 deg off "
            "the axis, tilted by 90 to 120 deg");
}

TEST(AlignmentFile, CarriesTheReferenceIntoThePosesFrame) {
  const std::string path = testing::TempDir() + "glint_align_test.toml";
  std::ofstream(path) << "offset_ms = 50.0\n[T_reference_poses]\nposition_mm = [100.0, 0.0, 0.0]\n"
                         "rotation_xyzw = [0.0, 0.0, 1.0, 0.0]\n[T_tool_body]\n"
                         "position_mm = [0.0, 0.0, 30.0]\nrotation_xyzw = [0.0, 0.0, 0.0, 1.0]\n";
  const Alignment alignment = load_alignment(path);
  const Pose tool{from_rotation_vector({0.2, 0.1, -0.3}), {0.1, 0.2, 0.5}};
  const Pose seen = alignment.T_reference_poses * tool * alignment.T_tool_body;
  const auto back = in_poses_frame({{Time{} + milliseconds(150), seen}}, alignment);
  EXPECT_EQ(back[0].time, Time{} + milliseconds(100));
  EXPECT_LT((back[0].pose.translation - tool.translation).norm(), 1e-12);
  EXPECT_LT(back[0].pose.rotation.angularDistance(tool.rotation), 1e-7);
  EXPECT_NEAR(seen.translation.x(), 0.1 - (tool * Vector3(0, 0, 0.03)).x(), 1e-12);
  std::ofstream(path) << "[T_reference_poses]\nposition_mm = [0, 0, 0]\n"
                         "rotation_xyzw = [1.0, 1.0, 0.0, 0.0]\n";
  test::expect_input_error([&] { (void)load_alignment(path); },
                           {":3: T_reference_poses.rotation_xyzw is not of length 1"});
  std::ofstream(path) << "offset_ms = 1.0\n";
  test::expect_input_error([&] { (void)load_alignment(path); },
                           {"no table [T_reference_poses]", "glint calibrate align"});
  std::remove(path.c_str());
}

}  // namespace
}  // namespace glint
