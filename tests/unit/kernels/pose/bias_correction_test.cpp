#include "kernels/pose/bias_correction.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <utility>

#include "kernels/motion/interpolate.hpp"
#include "tests/unit/kernels/pose/scene.hpp"

namespace glint {
namespace {

const Pose k_truth{from_rotation_vector({0.3, -0.7, 0.2}), {0.05, -0.1, 0.5}};

BiasCorrection correction(CorrectionFrame frame) {
  BiasCorrection out;
  out.frame = frame;
  out.translation_m = {0.001, -0.002, 0.003};
  out.rotation_rad = {0.01, 0.02, -0.005};
  out.range_m = {0.4, 0.6};
  out.off_axis_cosine = {0.9, 1.0};
  out.tilt_cosine = {-1, 1};
  return out;
}

TEST(BiasCorrection, TakesOffAnErrorAlongTheToolsAxes) {
  const BiasCorrection known = correction(CorrectionFrame::tool);
  const Pose error{from_rotation_vector(known.rotation_rad), known.translation_m};
  const CorrectedPose out = correct_bias(known, k_truth * error.inverse());
  EXPECT_EQ(out.reason, Reason::none);
  EXPECT_LT((out.T_camera_tool.translation - k_truth.translation).norm(), 1e-15);
  EXPECT_LT(out.T_camera_tool.rotation.angularDistance(k_truth.rotation), 1e-14);
}

TEST(BiasCorrection, TakesOffAnErrorAlongTheCamerasAxes) {
  const BiasCorrection known = correction(CorrectionFrame::camera);
  const Pose off{from_rotation_vector(-known.rotation_rad) * k_truth.rotation,
                 k_truth.translation - known.translation_m};
  const CorrectedPose out = correct_bias(known, off);
  EXPECT_EQ(out.reason, Reason::none);
  EXPECT_LT((out.T_camera_tool.translation - k_truth.translation).norm(), 1e-15);
  EXPECT_LT(out.T_camera_tool.rotation.angularDistance(k_truth.rotation), 1e-14);
}

void expect_left_alone(const BiasCorrection& known, const Pose& pose, Reason reason) {
  const CorrectedPose out = correct_bias(known, pose);
  EXPECT_EQ(out.reason, reason);
  EXPECT_EQ(std::memcmp(&out.T_camera_tool, &pose, sizeof pose), 0);
}

TEST(BiasCorrection, LeavesAloneWhatLiesOutsideOfWhatWasMeasured) {
  Pose far = k_truth;
  far.translation *= 1.2;
  expect_left_alone(correction(CorrectionFrame::tool), far, Reason::out_of_range);
  Pose near = k_truth;
  near.translation *= 0.7;
  expect_left_alone(correction(CorrectionFrame::camera), near, Reason::out_of_range);
  Pose aside = k_truth;
  aside.translation = {0.3, 0, 0.4};  // 37 degrees off the axis
  expect_left_alone(correction(CorrectionFrame::tool), aside, Reason::out_of_range);
  BiasCorrection upright = correction(CorrectionFrame::tool);
  upright.tilt_cosine = {-1, 0};
  expect_left_alone(upright, k_truth, Reason::out_of_range);
}

TEST(BiasCorrection, LeavesAloneWhereThereIsNoneAndWhatIsNoPose) {
  expect_left_alone({}, k_truth, Reason::not_prepared);
  Pose none = k_truth;
  none.translation.x() = std::numeric_limits<double>::quiet_NaN();
  expect_left_alone(correction(CorrectionFrame::tool), none, Reason::out_of_range);
}

TEST(BiasCorrection, HoldsAtBothEndsOfEachRangeAndNotBeyond) {
  const ViewGeometry seen = view_geometry(k_truth);
  const auto reason = [&](const BiasCorrection& known) {
    return correct_bias(known, k_truth).reason;
  };
  const auto beyond = [](double x, double to) { return std::nextafter(x, to); };
  const std::pair<ValidRange BiasCorrection::*, double> ranges[] = {
      {&BiasCorrection::range_m, seen.range_m},
      {&BiasCorrection::off_axis_cosine, seen.off_axis_cosine},
      {&BiasCorrection::tilt_cosine, seen.tilt_cosine}};
  for (const auto& [range, value] : ranges) {
    BiasCorrection known = correction(CorrectionFrame::tool);
    known.*range = {value, value};
    EXPECT_EQ(reason(known), Reason::none);
    known.*range = {beyond(value, 9), 9};
    EXPECT_EQ(reason(known), Reason::out_of_range);
    known.*range = {-9, beyond(value, -9)};
    EXPECT_EQ(reason(known), Reason::out_of_range);
  }
}

// A rotated tool beside the axis: range, angle off the axis and tilt against their angles.
TEST(BiasCorrection, SeesTheRangeTheAngleOffTheAxisAndTheTilt) {
  const ViewGeometry seen = view_geometry(
      {from_rotation_vector({0.7, 0, 0}), Vector3(0, -std::sin(0.3), std::cos(0.3)) * 0.8});
  EXPECT_NEAR(seen.range_m, 0.8, 1e-15);
  EXPECT_NEAR(seen.off_axis_cosine, std::cos(0.3), 1e-15);
  EXPECT_NEAR(seen.tilt_cosine, std::cos(0.7 - 0.3), 1e-15) << "z turns to -y, as the sight does";
  const ViewGeometry nowhere = view_geometry({});
  EXPECT_EQ(nowhere.range_m, 0);
  EXPECT_EQ(nowhere.off_axis_cosine, 1);
  EXPECT_EQ(nowhere.tilt_cosine, 1);
}

TEST(BiasCorrection, GivesTheSameBitsEverywhere) {
  test::Random random(1);
  test::BitHash hash;
  for (int trial = 0; trial < 1000; ++trial) {
    for (const auto frame : {CorrectionFrame::tool, CorrectionFrame::camera}) {
      BiasCorrection known = correction(frame);
      known.rotation_rad *= random.within(0, 3);
      const Pose out = correct_bias(known, k_truth).T_camera_tool;
      for (int i = 0; i < 4; ++i) hash.add(out.rotation.coeffs()[i]);
      for (int i = 0; i < 3; ++i) hash.add(out.translation[i]);
    }
  }
  EXPECT_EQ(hash.value(), 5063840306563722269u);
}

}  // namespace
}  // namespace glint
