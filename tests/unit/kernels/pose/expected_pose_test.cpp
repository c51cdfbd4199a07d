#include "kernels/pose/expected_pose.hpp"

#include <gtest/gtest.h>

#include <cstdio>

#include "kernels/pose/chi_square_limit.hpp"
#include "kernels/pose/lever_arm.hpp"
#include "platform/dense.hpp"
#include "tests/unit/kernels/pose/weighted_scene.hpp"

namespace glint::expected_pose_test {
namespace {

using test::Random;

const Vector3 k_place(0.08, -0.05, 0.5);
const MarkerVariance k_usual{0.01, 0, 0.01, 0.0015 * 0.0015};
const MarkerVariance k_imprecise{0.09, 0, 0.09, 0.01 * 0.01};
constexpr double k_translation_sigma_m = 0.003, k_rotation_sigma_rad = 0.03;

// A prediction with errors drawn from its covariance, about the centre of the markers.
PredictedPose expect(const Tool& tool, const Pose& truth, Random& random) {
  PredictedPose expected;
  expected.reference_m = test::mean_of_markers(tool);
  const auto noise = [&](double sigma) {
    return Vector3(sigma * Vector3(random.normal(), random.normal(), random.normal()));
  };
  const Quaternion rotation = from_rotation_vector(noise(k_rotation_sigma_rad)) * truth.rotation;
  const Vector3 middle = truth * expected.reference_m + noise(k_translation_sigma_m);
  expected.T_camera_tool = {rotation, middle - rotation * expected.reference_m};
  expected.covariance.diagonal() << Vector3::Constant(k_translation_sigma_m *
                                                      k_translation_sigma_m),
      Vector3::Constant(k_rotation_sigma_rad * k_rotation_sigma_rad);
  return expected;
}

TEST(ExpectedPose, SurprisesByChiSquareOfSixWhereAllIsAsDeclared) {
  Random random(1);
  const Tool tool = test::five_marker_pen();
  constexpr int k_trials = 3000;
  double sum = 0;
  int beyond = 0;
  for (int trial = 0; trial < k_trials; ++trial) {
    const Pose truth = test::tilted_pose(tool, random.within(0.4, 1), k_place, random);
    const auto markers = test::weighted_view(tool, truth, k_usual, 1, random);
    // The tip is 0.15 m from the centre, which is the prediction's reference.
    const Vector3 tip = test::mean_of_markers(tool) + Vector3(0, 0, 0.15);
    const RefinedPose pose = refine_pose(markers, tip);
    ASSERT_EQ(pose.reason, Reason::none);
    const double distance_square =
        mahalanobis_square(expect(tool, truth, random), pose.T_camera_tool, pose.covariance, tip);
    sum += distance_square;
    beyond += distance_square > chi_square_limit(6) ? 1 : 0;
  }
  EXPECT_NEAR(sum / k_trials, 6, 0.3);  // mean of 3,000 chi-squares of 6: sigma 0.063
  EXPECT_LE(beyond, 4);                 // 0.3 on average
}

// Full covariances of both poses; that of the measured pose is about another point.
TEST(ExpectedPose, SurpriseIsTheDistanceInBothCovariancesAboutItsReference) {
  Random random(4);
  const auto covariance = [&random] {
    Matrix6 root;
    for (int i = 0; i < 36; ++i) root(i) = 0.01 * random.normal();
    return Matrix6(root * root.transpose());
  };
  for (int trial = 0; trial < 50; ++trial) {
    PredictedPose expected{
        {random.rotation(), random.vector(0.3)}, covariance(), random.vector(0.1)};
    const Vector3 turn = random.vector(0.1), reference_m = random.vector(0.1);
    const Pose found{from_rotation_vector(turn) * expected.T_camera_tool.rotation,
                     expected.T_camera_tool.translation + random.vector(0.02)};
    const Matrix6 own = covariance();
    const Matrix6 j = pose_by_pose(found.rotation * (expected.reference_m - reference_m));
    Vector6 apart;
    apart << found * expected.reference_m - expected.T_camera_tool * expected.reference_m, turn;
    const Matrix6 both = expected.covariance + j * own * j.transpose();
    const double distance = apart.dot(Matrix6(inverse_of(both)) * apart);
    EXPECT_NEAR(mahalanobis_square(expected, found, own, reference_m) / distance, 1, 1e-7);
  }
}

TEST(ExpectedPose, WithoutACovarianceNothingIsExpected) {
  const PredictedPose certain;
  EXPECT_EQ(mahalanobis_square(certain, Pose{}, Matrix6::Zero(), Vector3::Zero()),
            k_mahalanobis_unknown);
}

TEST(ExpectedPose, LeavesThePoseToTheMarkers) {
  Random random(2);
  const Tool tool = test::five_marker_pen();
  for (int trial = 0; trial < 100; ++trial) {
    const Pose truth = test::tilted_pose(tool, 0.6, k_place, random);
    const auto markers = test::weighted_view(tool, truth, k_usual, 1, random);
    const PredictedPose expected = expect(tool, truth, random);
    const RefinedPose without_prediction = refine_pose(markers, tool.tip_m);
    const RefinedPose with_prediction = refine_pose(markers, tool.tip_m, nullptr, {}, &expected);
    EXPECT_EQ(without_prediction.mahalanobis_square, 0);
    EXPECT_GT(with_prediction.mahalanobis_square, 0);
    // Both initial guesses converge to one minimum, within the fit's convergence limit.
    EXPECT_LT(
        (with_prediction.T_camera_tool * tool.tip_m - without_prediction.T_camera_tool * tool.tip_m)
            .norm(),
        1e-5);
    EXPECT_TRUE(with_prediction.covariance.isApprox(without_prediction.covariance, 1e-3));
  }
}

struct Wrong {
  int without_prediction = 0, with_prediction = 0;
};

// Three markers of a flat tool seen face-on: two minima that chi-square hardly separates.
TEST(ExpectedPose, TellsAFlatToolsMinimaApart) {
  Random random(3);
  const Tool tool = test::flat_tool();
  Wrong gross;
  for (int trial = 0; trial < 1000; ++trial) {
    const Pose truth = test::tilted_pose(tool, random.within(0.2, 0.5), k_place, random);
    const auto markers = test::weighted_view(tool, truth, k_imprecise, 1, random);
    const PredictedPose expected = expect(tool, truth, random);
    const auto count = [&](const PredictedPose* by, int& wrong) {
      const RefinedPose pose = refine_pose({markers.data(), 3}, tool.tip_m, nullptr, {}, by);
      wrong += test::angle_between(pose.T_camera_tool.rotation, truth.rotation) > 0.35 ? 1 : 0;
    };
    count(nullptr, gross.without_prediction);
    count(&expected, gross.with_prediction);
  }
  std::printf("  grossly off: %d alone, %d with an expectation\n", gross.without_prediction,
              gross.with_prediction);
  EXPECT_GT(gross.without_prediction, 80);  // otherwise the test has no effect
  EXPECT_LE(gross.with_prediction,
            gross.without_prediction / 2);  // the rest is noise, not the other minimum
}

}  // namespace
}  // namespace glint::expected_pose_test
