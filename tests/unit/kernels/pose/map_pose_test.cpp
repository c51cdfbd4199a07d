#include "kernels/pose/map_pose.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <span>

#include "kernels/motion/interpolate.hpp"
#include "kernels/pose/lever_arm.hpp"
#include "kernels/pose/refine_pose.hpp"
#include "tests/unit/kernels/pose/weighted_scene.hpp"

namespace glint::map_pose_test {
namespace {

using test::Random;

const Vector3 k_place(0.02, -0.03, 0.6);
const MarkerVariance k_usual{0.01, 0, 0.01, 0.0015 * 0.0015};
constexpr int k_steps = k_refine_steps_max;

Matrix6 covariance_of_sigmas(double shift_m, double turn_rad) {
  Matrix6 covariance = Matrix6::Zero();
  covariance.diagonal() << Vector3::Constant(shift_m * shift_m),
      Vector3::Constant(turn_rad * turn_rad);
  return covariance;
}

Vector6 difference(const Pose& a, const Pose& b, const Vector3& at) {
  Vector6 out;
  out << a * at - b * at, rotation_vector(a.rotation * b.rotation.conjugate());
  return out;
}

// Returns the information-weighted mean of the prediction and a measured pose (Kalman update).
PredictedPose fused(const PredictedPose& expected, const Pose& pose, const Matrix6& covariance) {
  const Matrix6 gain =
      expected.covariance * pose_factor(expected.covariance + covariance).value.inverse();
  const Vector6 step = gain * difference(pose, expected.T_camera_tool, expected.reference_m);
  PredictedPose out = expected;
  out.T_camera_tool.rotation =
      (from_rotation_vector(step.tail<3>()) * expected.T_camera_tool.rotation).normalized();
  out.T_camera_tool.translation = expected.T_camera_tool * expected.reference_m + step.head<3>() -
                                  out.T_camera_tool.rotation * expected.reference_m;
  out.covariance = expected.covariance - gain * expected.covariance;
  return out;
}

TEST(AgreedPose, LeadsAFilterToWhereMarkersAndExpectationAgree) {
  Random random(1);
  const Tool tool = test::five_marker_pen();
  const Vector3 mean = test::mean_of_markers(tool);
  for (int trial = 0; trial < 200; ++trial) {
    const Pose truth = test::tilted_pose(tool, random.within(0.4, 1), k_place, random);
    const auto markers = test::weighted_view(tool, truth, k_usual, 1, random);
    PredictedPose expected{truth, covariance_of_sigmas(0.002, 0.02), mean};
    expected.T_camera_tool.translation += Vector3(0.002, -0.001, 0.002);
    const MapPose agreed = map_pose(markers, expected, k_steps);
    ASSERT_EQ(agreed.reason, Reason::none);
    const PosePrior prior{expected.T_camera_tool, pose_factor(expected.covariance).value.inverse(),
                          mean};
    const WeightedFit best = fit_weighted(markers, mean, expected.T_camera_tool, &prior, k_steps);
    const PredictedPose filtered = fused(expected, agreed.T_camera_tool, agreed.covariance);
    const Vector6 apart = difference(filtered.T_camera_tool, best.T_camera_tool, mean);
    EXPECT_LT(apart.head<3>().norm(), 1e-5);
    EXPECT_LT(apart.tail<3>().norm(), 1e-4);
    const Matrix6 sure = pose_factor(best.information).value.inverse();
    EXPECT_LT((filtered.covariance - sure).norm(), 0.01 * sure.norm());
  }
}

// Three markers across the line of sight, one of them 8 mm from the line of the others. A rotation
// about that line moves this marker along its ray; across the ray it moves only with the cosine.
Tool nearly_collinear_tool() { return test::tool_of<3>({{-60, 0, 0}, {10, 8, 0}, {60, 0, 0}}); }

// Static tool, filtered frame by frame. Returns the NEES of the rotation about the line.
template <class Reading>
double rotation_nees(const Reading& reading) {
  constexpr int k_runs = 200, k_frames = 60;
  Random random(2);
  const Tool tool = nearly_collinear_tool();
  const Vector3 mean = test::mean_of_markers(tool);
  double sum = 0;
  for (int run = 0; run < k_runs; ++run) {
    const Pose truth{Quaternion::Identity(), k_place - mean};
    PredictedPose predicted{truth, covariance_of_sigmas(0.001, 0.03), mean};
    const auto noise = [&] { return Vector3(random.normal(), random.normal(), random.normal()); };
    predicted.T_camera_tool.rotation = from_rotation_vector(0.03 * noise());
    predicted.T_camera_tool.translation =
        truth * mean + 0.001 * noise() - predicted.T_camera_tool.rotation * mean;
    for (int frame = 0; frame < k_frames; ++frame) {
      predicted.covariance += covariance_of_sigmas(0.0005, 0.03);  // process noise
      const auto markers = test::weighted_view(tool, truth, k_usual, 1, random);
      reading(markers, mean, predicted);
    }
    const Vector6 error = difference(predicted.T_camera_tool, truth, mean);
    sum += error(3) * error(3) / predicted.covariance(3, 3) / k_runs;
  }
  return sum;
}

TEST(AgreedPose, LeadsNoFilterAwayWhereOnlyACosineTellsATurn) {
  const double agreed =
      rotation_nees([](const auto& markers, const Vector3&, PredictedPose& predicted) {
        const MapPose found = map_pose(markers, predicted, k_steps);
        ASSERT_EQ(found.reason, Reason::none);
        predicted = fused(predicted, found.T_camera_tool, found.covariance);
      });
  const double alone =
      rotation_nees([](const auto& markers, const Vector3& mean, PredictedPose& predicted) {
        const RefinedPose found = refine_pose(markers, mean, nullptr, {}, &predicted);
        if (found.reason == Reason::none)
          predicted = fused(predicted, found.T_camera_tool, found.covariance);
      });
  std::printf("  read near the expectation %.2f, the markers' own best pose %.2f\n", agreed, alone);
  EXPECT_LT(agreed, 1.5);
  EXPECT_GT(agreed, 0.5);
  EXPECT_GT(alone, 2 * agreed) << "else there is nothing to mend";
}

// Two precise and two imprecise markers: only the rotation about the precise ones' line is
// uncertain. The filter's position must match the fit with the prior, also after a large rotation.
TEST(AgreedPose, ItsReferenceGoesStraightOnHoweverFarTheStepTurns) {
  Random random(4);
  const Tool tool = test::five_marker_pen();
  Tool four = tool;
  four.marker_count = 4;
  const Vector3 mean = test::mean_of_markers(four), reference = mean + Vector3(0.02, 0.03, -0.04);
  const MarkerVariance imprecise{16, 0, 16, 0.03 * 0.03};
  double rotation_max = 0;
  for (int trial = 0; trial < 200; ++trial) {
    const Pose truth = test::tilted_pose(tool, random.within(0.4, 1), k_place, random);
    auto markers = test::weighted_view(four, truth, k_usual, 1, random);
    const auto imprecise_markers = test::weighted_view(four, truth, imprecise, 1, random);
    std::copy(imprecise_markers.begin() + 2, imprecise_markers.end(), markers.begin() + 2);
    const PredictedPose expected{truth, covariance_of_sigmas(0.003, 0.02), reference};
    const MapPose agreed = map_pose(markers, expected, k_steps);
    ASSERT_EQ(agreed.reason, Reason::none);
    const PosePrior prior{truth, pose_factor(expected.covariance).value.inverse(), reference};
    const WeightedFit best = fit_weighted(markers, mean, truth, &prior, k_steps);
    const PredictedPose filtered = fused(expected, agreed.T_camera_tool, agreed.covariance);
    const Vector6 apart = difference(filtered.T_camera_tool, best.T_camera_tool, reference);
    EXPECT_LT(apart.head<3>().norm(), 5e-5) << trial;
    rotation_max =
        std::max(rotation_max, difference(agreed.T_camera_tool, truth, reference).tail<3>().norm());
  }
  EXPECT_GT(rotation_max, 0.2) << "else no step turned far";
}

// The tilt is smaller than the ranges can resolve. Both minima are some degrees off, and the
// covariance of each describes its own slope alone.
TEST(AgreedPose, StatesFaceOnWhatTheRangesShow) {
  Random random(5);
  const Tool tool = test::flat_tool();
  const Vector3 mean = test::mean_of_markers(tool);
  const MarkerVariance noisy{0.09, 0, 0.09, 0.005 * 0.005};
  constexpr int k_trials = 2000;
  double facing = 0, likeliest = 0;
  for (int trial = 0; trial < k_trials; ++trial) {
    const Pose truth = test::tilted_pose(tool, random.within(0, 0.08), k_place, random);
    const auto markers = test::weighted_view(tool, truth, noisy, 1, random);
    const RefinedPose pose = refine_pose(markers, mean);
    ASSERT_EQ(pose.reason, Reason::none);
    EXPECT_TRUE(pose.shallow);
    const LinearisedPose near =
        linearised_pose(markers, face_on_pose(markers, pose.T_camera_tool), mean);
    ASSERT_EQ(near.reason, Reason::none);
    const auto nees = [&](const Pose& found, const Matrix6& covariance) {
      const Vector6 error = difference(found, truth, mean);
      return error.dot(pose_factor(covariance).value.solve(error)) / (6 * k_trials);
    };
    facing += nees(near.T_camera_tool, near.covariance);
    likeliest += nees(pose.T_camera_tool, pose.covariance);
  }
  std::printf("  NEES/6: face-on %.2f, the likeliest pose %.2f\n", facing, likeliest);
  EXPECT_NEAR(facing, 1, 0.1);
  EXPECT_GT(likeliest, 1.15 * facing) << "else there is nothing to mend";
}

TEST(AgreedPose, TurnsAFlatToolFaceOnAboutItsMean) {
  Random random(6);
  const Tool tool = test::flat_tool();
  const Pose tilted = test::tilted_pose(tool, 0.4, k_place, random);
  const auto markers = test::weighted_view(tool, tilted, k_usual, 0, random);
  const Pose facing = face_on_pose(markers, tilted);
  const Vector3 mean = test::mean_of_markers(tool);
  EXPECT_LT((facing * mean - tilted * mean).norm(), 1e-9);
  const Vector3 normal = facing.rotation * Vector3::UnitX();
  EXPECT_NEAR(std::abs(normal.dot((facing * mean).normalized())), 1, 1e-6);
  EXPECT_NEAR(facing.rotation.angularDistance(tilted.rotation), 0.4, 1e-6);
}

TEST(AgreedPose, StatesItsStepsAndTheChiSquareOfMarkersAndExpectation) {
  Random random(7);
  const Tool tool = test::five_marker_pen();
  const Vector3 mean = test::mean_of_markers(tool), reference = mean + Vector3(0.01, 0, 0.02);
  for (const int steps_max : {2, 12}) {
    const Pose truth = test::tilted_pose(tool, 0.6, k_place, random);
    const auto markers = test::weighted_view(tool, truth, k_usual, 1, random);
    PredictedPose expected{truth, covariance_of_sigmas(0.002, 0.02), reference};
    expected.T_camera_tool.translation += Vector3(0.004, -0.003, 0.005);
    const MapPose agreed = map_pose(markers, expected, steps_max);
    const PosePrior prior{expected.T_camera_tool, pose_factor(expected.covariance).value.inverse(),
                          reference};
    const WeightedFit fit = fit_weighted(markers, mean, expected.T_camera_tool, &prior, steps_max);
    ASSERT_EQ(agreed.reason, Reason::none);
    EXPECT_EQ(agreed.steps, fit.steps);
    EXPECT_EQ(agreed.chi_square, fit.chi_square);
    // At the pose where both agree: the markers' own step, information and chi-square.
    const LinearisedPose near = linearised_pose(markers, fit.T_camera_tool, reference);
    EXPECT_EQ(agreed.covariance, near.covariance);
    EXPECT_EQ(agreed.T_camera_tool.translation, near.T_camera_tool.translation);
    NormalEquations alone;
    ASSERT_TRUE(add_markers(markers, fit.T_camera_tool, mean, alone));
    EXPECT_EQ(near.chi_square, alone.chi_square);
    const Vector3 lever = fit.T_camera_tool.rotation * (reference - mean);
    const Matrix6 inverse = pose_factor(alone.matrix).value.inverse();
    EXPECT_LT((near.covariance - moved_covariance(inverse, lever)).norm(), 1e-12);
    const Vector6 step = -inverse * alone.gradient;
    const Vector3 turn = step.tail<3>();
    const Vector3 moved = fit.T_camera_tool * reference + step.head<3>() + turn.cross(lever);
    EXPECT_LT((near.T_camera_tool * reference - moved).norm(), 1e-9);
    EXPECT_LT(test::angle_between(near.T_camera_tool.rotation,
                                  from_rotation_vector(turn) * fit.T_camera_tool.rotation),
              1e-8);
  }
}

TEST(AgreedPose, NearAPoseBehindTheCameraIsNone) {
  Random random(8);
  const Tool tool = test::five_marker_pen();
  const Pose truth = test::tilted_pose(tool, 0.6, k_place, random);
  const auto markers = test::weighted_view(tool, truth, k_usual, 1, random);
  const Vector3 mean = test::mean_of_markers(tool);
  EXPECT_EQ(linearised_pose(markers, truth, mean).reason, Reason::none);
  EXPECT_EQ(linearised_pose(markers, {truth.rotation, -truth.translation}, mean).reason,
            Reason::degenerate);
  EXPECT_EQ(linearised_pose(std::span(markers).first(1), truth, mean).reason, Reason::degenerate);
}

TEST(AgreedPose, SaysWhereThereIsNone) {
  Random random(3);
  const Tool tool = test::five_marker_pen();
  const Vector3 mean = test::mean_of_markers(tool);
  const Pose truth = test::tilted_pose(tool, 0.6, k_place, random);
  const auto markers = test::weighted_view(tool, truth, k_usual, 1, random);
  const PredictedPose certain{truth, Matrix6::Zero(), mean};
  EXPECT_EQ(map_pose(markers, certain, k_steps).reason, Reason::degenerate);
  const PredictedPose expected{truth, covariance_of_sigmas(0.002, 0.02), mean};
  const auto one = std::span(markers).first(1);
  EXPECT_EQ(map_pose(one, expected, k_steps).reason, Reason::degenerate)
      << "one marker alone fixes no pose";
  PredictedPose behind = expected;
  behind.T_camera_tool.translation.z() -= 2;
  EXPECT_EQ(map_pose(markers, behind, k_steps).reason, Reason::degenerate);
}

}  // namespace
}  // namespace glint::map_pose_test
