#include "kernels/pose/refine_pose.hpp"

#include <gtest/gtest.h>

#include <cstdio>
#include <limits>

#include "kernels/pose/depth_flip.hpp"
#include "kernels/pose/rigid_fit.hpp"
#include "tests/unit/kernels/pose/weighted_scene.hpp"

namespace glint::refine_pose_test {
namespace {

using test::Random;

const Vector3 k_place(0.08, -0.05, 0.5);
const MarkerVariance k_skewed{0.01, 0.004, 0.0064, 0.002 * 0.002};

Vector6 error_of(const RefinedPose& pose, const Pose& truth, const Vector3& reference) {
  Vector6 error;
  error << pose.T_camera_tool * reference - truth * reference,
      rotation_vector(pose.T_camera_tool.rotation * truth.rotation.conjugate());
  return error;
}

// An exact square seen face-on: by symmetry the covariance is diagonal and known in closed form.
TEST(RefinePose, CovarianceOfASquareSeenStraightOnIsWhatItsGeometrySays) {
  const Tool square = test::tool_of<4>({{50, 0, 0}, {0, 50, 0}, {-50, 0, 0}, {0, -50, 0}});
  Random random(1);
  const Pose pose{Quaternion::Identity(), Vector3(0, 0, 100)};  // far away: no perspective
  const double across = 0.001 * 253 / 100;
  const MarkerVariance variance{across * across, 0, across * across, 0.002 * 0.002};
  const auto markers = test::weighted_view(square, pose, variance, 0, random);
  const RefinedPose refined = refine_pose(markers, Vector3::Zero());
  ASSERT_EQ(refined.reason, Reason::none);
  EXPECT_EQ(refined.degrees_of_freedom, 6);
  const double s = 0.001 * 0.001;
  const double expected[6] = {s / 4, s / 4, 4 * s / 4, 4 * s / 0.005, 4 * s / 0.005, s / 0.01};
  for (int i = 0; i < 6; ++i) EXPECT_NEAR(refined.covariance(i, i) / expected[i], 1, 1e-3) << i;
}

struct Scatter {
  int fits = 0, gross = 0, bad = 0;
  double nees = 0;  // mean over six
  Matrix6 errors = Matrix6::Zero(), predicted = Matrix6::Zero();
  RefineWork most;
};

Scatter scatter_of(const Tool& tool, double tilt, const MarkerVariance& variance, int trials,
                   Random& random) {
  Scatter scatter;
  const Vector3 tip = test::mean_of_markers(tool) + Vector3(0, 0, 0.15);
  for (int trial = 0; trial < trials; ++trial) {
    const Pose truth = test::tilted_pose(tool, tilt, k_place, random);
    const auto markers = test::weighted_view(tool, truth, variance, 1, random);
    const RefinedPose pose = refine_pose(markers, tip);
    scatter.bad += pose.reason == Reason::none ? 0 : 1;
    scatter.most.steps = std::max(scatter.most.steps, pose.work.steps);
    if (pose.reason != Reason::none) continue;
    ++scatter.fits;
    const Vector6 error = error_of(pose, truth, tip);
    scatter.gross += error.tail<3>().norm() > 0.26 ? 1 : 0;
    scatter.nees += error.dot(pose_factor(pose.covariance).value.solve(error)) / 6;
    scatter.errors += error * error.transpose();
    scatter.predicted += pose.covariance;
  }
  scatter.nees /= scatter.fits;
  return scatter;
}

TEST(RefinePose, ScattersAsItsCovarianceSaysForFlatAndSolidToolsAndSkewedPixels) {
  Random random(2);
  for (const Tool& tool : {test::flat_tool(), test::five_marker_pen()}) {
    for (const double tilt : {0.4, 0.8}) {
      const Scatter scatter = scatter_of(tool, tilt, k_skewed, 6000, random);
      std::printf("  %d markers, tilt %.1f: NEES/6 %.3f, bad %d, steps at most %d\n",
                  tool.marker_count, tilt, scatter.nees, scatter.bad, scatter.most.steps);
      // Mean of 6,000 trials of six squares: sigma 0.0075.
      EXPECT_NEAR(scatter.nees, 1, 0.04);
      EXPECT_LE(scatter.bad, 4);  // 0.6 by the tail of chi-square
      EXPECT_EQ(scatter.gross, 0);
      for (int i = 0; i < 6; ++i)
        EXPECT_NEAR(scatter.errors(i, i) / scatter.predicted(i, i), 1, 0.08) << i;
    }
  }
}

// Many views of a flat tool: from the true pose or its flip as the initial guess, the fit finds the
// true one.
TEST(RefinePose, TakesTheBetterOfAFlatToolsTwoMinimaAndTellsHowFarTheOtherIs) {
  Random random(3);
  const Tool tool = test::flat_tool();
  const Vector3 mean = test::mean_of_markers(tool);
  const MarkerVariance noisy{0.01, 0, 0.01, 0.005 * 0.005};
  int svd_gross = 0, gross = 0, others = 0;
  for (int trial = 0; trial < 2000; ++trial) {
    const Pose truth = test::tilted_pose(tool, 0.5, k_place, random);
    const auto markers = test::weighted_view(tool, truth, noisy, 1, random);
    std::vector<Vector3> model, measured;
    for (const WeightedMarker& marker : markers) {
      model.push_back(marker.model_m);
      measured.push_back(marker.measured_m());
    }
    const RigidFit rigid = fit_rigid(model, measured);
    svd_gross += test::angle_between(rigid.transform.rotation, truth.rotation) > 0.26 ? 1 : 0;
    const RefinedPose pose = refine_pose(markers, mean);
    const double off = test::angle_between(pose.T_camera_tool.rotation, truth.rotation);
    gross += off > 0.26 ? 1 : 0;
    if (!pose.other.exists) continue;
    ++others;
    EXPECT_GE(pose.other.delta_chi_square, 0);
    EXPECT_GT(test::angle_between(pose.other.T_camera_tool.rotation, pose.T_camera_tool.rotation),
              0.3);
  }
  std::printf("  of 2000 the rigid fit is grossly off in %d, the refined in %d; two minima in %d\n",
              svd_gross, gross, others);
  EXPECT_GT(svd_gross, 10);  // otherwise the test has no effect
  EXPECT_EQ(gross, 0);
  EXPECT_GT(others, 1900);
}

// No four of its markers are coplanar: its flip is no second minimum, which three steps show.
TEST(RefinePose, SparesTheFlipOfASolidTool) {
  Random random(14);
  const Tool tool = test::five_marker_pen();
  const MarkerVariance noisy{0.01, 0, 0.01, 0.002 * 0.002};
  constexpr int k_views = 500;
  int steps = 0;
  for (int trial = 0; trial < k_views; ++trial) {
    const Pose truth = test::tilted_pose(tool, random.within(0, 1), k_place, random);
    const auto markers = test::weighted_view(tool, truth, noisy, 1, random);
    const RefinedPose pose = refine_pose(markers, test::mean_of_markers(tool));
    ASSERT_EQ(pose.reason, Reason::none);
    EXPECT_LT(test::angle_between(pose.T_camera_tool.rotation, truth.rotation), 0.1);
    EXPECT_FALSE(pose.other.exists);
    steps += pose.work.steps;
  }
  EXPECT_LT(static_cast<double>(steps) / k_views, 6.5);
}

// Imprecise ranges of the mirror image: the rigid fit selects it, the pixels contradict it.
TEST(RefinePose, LeavesTheMirrorImageThatTheRangesAloneWouldTake) {
  Random random(11);
  const Tool tool = test::flat_tool();
  const Vector3 mean = test::mean_of_markers(tool);
  const MarkerVariance imprecise{0.01, 0, 0.01, 0.03 * 0.03};
  for (int trial = 0; trial < 100; ++trial) {
    const Pose truth = test::tilted_pose(tool, random.within(0.4, 0.8), k_place, random);
    auto markers = test::weighted_view(tool, truth, imprecise, 0, random);
    const Pose mirror = depth_flipped(truth, flattest_direction(markers, mean), mean);
    for (WeightedMarker& marker : markers) marker.range_m = (mirror * marker.model_m).norm();
    const RefinedPose pose = refine_pose(markers, tool.tip_m);
    ASSERT_EQ(pose.reason, Reason::none);
    EXPECT_LT(test::angle_between(pose.T_camera_tool.rotation, truth.rotation), 0.1);
    ASSERT_TRUE(pose.other.exists);
    EXPECT_GT(pose.other.delta_chi_square, 9);
    EXPECT_LT(test::angle_between(pose.other.T_camera_tool.rotation, mirror.rotation), 0.3);
  }
}

TEST(RefinePose, LeavesOutTheOneMarkerThatDoesNotFit) {
  Random random(4);
  const Tool tool = test::five_marker_pen();
  int named = 0;
  for (int trial = 0; trial < 300; ++trial) {
    const Pose truth = test::tilted_pose(tool, random.within(0, 1), k_place, random);
    auto markers = test::weighted_view(tool, truth, k_skewed, 1, random);
    const int bad = random.below(5);
    markers[static_cast<std::size_t>(bad)].range_m += 0.03;
    const RefinedPose pose = refine_pose(markers, tool.tip_m);
    ASSERT_EQ(pose.reason, Reason::none);
    EXPECT_EQ(pose.degrees_of_freedom, 6);
    named += pose.rejected == bad ? 1 : 0;
    if (pose.rejected != bad) continue;
    const Vector6 error = error_of(pose, truth, tool.tip_m);
    EXPECT_LT(error.dot(pose_factor(pose.covariance).value.solve(error)), 40);
  }
  EXPECT_GE(named, 297);
}

// An outlier of six sigmas: several fits without one marker pass the test, and the least chi-square
// is chosen.
TEST(RefinePose, LeavesOutTheLikeliestWhereSeveralWouldDo) {
  Random random(12);
  int several = 0, named = 0;
  for (int trial = 0; trial < 400; ++trial) {
    const Tool tool = test::random_tool(random, 6);
    const Pose truth = test::tilted_pose(tool, random.within(0, 1), k_place, random);
    auto markers = test::weighted_view(tool, truth, k_skewed, 1, random);
    markers[1].range_m += 0.015;
    const RefinedPose pose = refine_pose(markers, tool.tip_m);
    if (pose.reason != Reason::none || pose.rejected < 0) continue;
    ++several;
    named += pose.rejected == 1 ? 1 : 0;
  }
  std::printf("  of %d left out one marker, %d the wrong one\n", several, several - named);
  EXPECT_GT(several, 300);
  EXPECT_EQ(named, several);  // the last that passes instead of the least: 3 of 383 wrong
}

TEST(RefinePose, CallsItABadFitWhereNoSingleMarkerIsToBlame) {
  Random random(13);
  for (int trial = 0; trial < 50; ++trial) {
    const Tool tool = test::random_tool(random, 6);
    const Pose truth = test::tilted_pose(tool, 0.5, k_place, random);
    auto markers = test::weighted_view(tool, truth, k_skewed, 1, random);
    markers[0].range_m += 0.1;
    markers[3].range_m -= 0.1;
    const RefinedPose pose = refine_pose(markers, tool.tip_m);
    EXPECT_EQ(pose.reason, Reason::bad_fit);
    EXPECT_EQ(pose.rejected, -1);
  }
}

TEST(RefinePose, CallsFourMarkersOfWhichOneIsWrongABadFit) {
  Random random(5);
  const Tool tool = test::flat_tool();
  const Pose truth = test::tilted_pose(tool, 0.5, k_place, random);
  auto markers = test::weighted_view(tool, truth, k_skewed, 0, random);
  markers[1].range_m += 0.03;
  const RefinedPose pose = refine_pose(markers, tool.tip_m);
  EXPECT_EQ(pose.reason, Reason::bad_fit);
  EXPECT_EQ(pose.rejected, -1);
  EXPECT_GT(pose.chi_square, 30);
}

// A prior from an earlier estimate with the same noise has the weight of a second measurement.
TEST(RefinePose, APriorCountsLikeTheMeasurementItStandsFor) {
  Random random(6);
  const Tool tool = test::five_marker_pen();
  for (int trial = 0; trial < 200; ++trial) {
    const Pose truth = test::tilted_pose(tool, 0.6, k_place, random);
    const auto one = test::weighted_view(tool, truth, k_skewed, 1, random);
    const auto two = test::weighted_view(tool, truth, k_skewed, 1, random);
    std::vector<WeightedMarker> both = one;
    both.insert(both.end(), two.begin(), two.begin() + 3);
    const RefinedPose first = refine_pose({two.data(), 3}, tool.tip_m);
    ASSERT_EQ(first.reason, Reason::none);
    const PosePrior prior{first.T_camera_tool, pose_factor(first.covariance).value.inverse(),
                          tool.tip_m};
    const RefinedPose updated = refine_pose(one, tool.tip_m, &prior);
    const RefinedPose together = refine_pose(both, tool.tip_m);
    ASSERT_EQ(updated.reason, Reason::none);
    EXPECT_EQ(updated.degrees_of_freedom, 15);
    const PoseFactor covariance_factor = pose_factor(together.covariance).value;
    const Vector6 apart = error_of(updated, together.T_camera_tool, tool.tip_m);
    EXPECT_LT(apart.dot(covariance_factor.solve(apart)), 0.4)
        << trial;  // second order in the noise
    for (int i = 0; i < 6; ++i)
      EXPECT_NEAR(updated.covariance(i, i) / together.covariance(i, i), 1, 0.1);
  }
}

TEST(RefinePose, OneAndTwoMarkersImproveAPrior) {
  Random random(7);
  const Tool tool = test::five_marker_pen();
  double before = 0, after[2] = {0, 0}, nees[2] = {0, 0};
  constexpr int trials = 2000;
  for (int trial = 0; trial < trials; ++trial) {
    const Pose truth = test::tilted_pose(tool, 0.6, k_place, random);
    const auto markers = test::weighted_view(tool, truth, k_skewed, 1, random);
    const Vector3 shift = random.vector(0.005), turn = random.vector(0.02);
    PosePrior prior;
    prior.reference_m = test::mean_of_markers(tool);
    prior.T_camera_tool.rotation = from_rotation_vector(turn) * truth.rotation;
    prior.T_camera_tool.translation =
        truth * prior.reference_m + shift - prior.T_camera_tool.rotation * prior.reference_m;
    prior.information.topLeftCorner<3, 3>() = Matrix3::Identity() / (0.005 * 0.005);
    prior.information.bottomRightCorner<3, 3>() = Matrix3::Identity() / (0.02 * 0.02);
    before += shift.squaredNorm() / trials;
    for (std::size_t n = 1; n <= 2; ++n) {
      const RefinedPose pose = refine_pose({markers.data(), n}, prior.reference_m, &prior);
      ASSERT_EQ(pose.reason, Reason::none);
      const Vector6 error = error_of(pose, truth, prior.reference_m);
      after[n - 1] += error.head<3>().squaredNorm() / trials;
      nees[n - 1] += error.dot(pose_factor(pose.covariance).value.solve(error)) / (6 * trials);
    }
  }
  EXPECT_LT(after[0], 0.3 * before);
  EXPECT_LT(after[1], 0.7 * after[0]);
  std::printf("  mean squares, m2: %.2g, with one marker %.2g, with two %.2g\n", before, after[0],
              after[1]);
  EXPECT_NEAR(nees[0], 1, 0.05);
  EXPECT_NEAR(nees[1], 1, 0.05);
}

TEST(RefinePose, SaysWhyMarkersFixNoPose) {
  Random random(8);
  const Tool tool = test::flat_tool();
  const Pose truth = test::tilted_pose(tool, 0.5, k_place, random);
  auto markers = test::weighted_view(tool, truth, k_skewed, 0, random);
  const PosePrior nothing{truth, Matrix6::Zero(), Vector3::Zero()};
  const Vector3& tip = tool.tip_m;
  EXPECT_EQ(refine_pose({}, tip).reason, Reason::too_few_markers);
  EXPECT_EQ(refine_pose({markers.data(), 2}, tip).reason, Reason::too_few_markers);
  EXPECT_EQ(refine_pose({}, tip, &nothing).reason, Reason::too_few_markers);
  EXPECT_EQ(refine_pose({markers.data(), 2}, tip, &nothing).reason, Reason::degenerate);
  const std::vector<WeightedMarker> nine(9, markers[0]);
  EXPECT_EQ(refine_pose(nine, tip).reason, Reason::too_few_markers);
  const std::vector<WeightedMarker> same(4, markers[0]);
  EXPECT_EQ(refine_pose(same, tip).reason, Reason::degenerate);
  for (std::size_t i = 0; i < 4; ++i) markers[i].model_m = Vector3(0.03 * double(i), 0, 0);
  EXPECT_EQ(refine_pose(markers, tip).reason, Reason::collinear);
}

// Eight markers, one to eight of them wrong: with two or more, removing a single one does not help.
TEST(RefinePose, EndsWithinItsDeclaredWorkAtItsWorst) {
  Random random(9);
  RefineWork most;
  for (int trial = 0; trial < 300; ++trial) {
    const Tool tool = test::random_tool(random, 8);
    const Pose truth = test::tilted_pose(tool, random.within(0, 1.5), k_place, random);
    auto markers = test::weighted_view(tool, truth, k_skewed, 1, random);
    for (int bad = 0; bad < 1 + trial % 8; ++bad)
      markers[static_cast<std::size_t>(bad)].range_m += random.within(-0.3, 0.3);
    for (const int steps_max : {3, k_refine_steps_max}) {
      const RefineSettings settings{steps_max, 1};
      const RefinedPose pose = refine_pose(markers, tool.tip_m, nullptr, settings);
      const RefineWork worst = refine_work_max(8, settings);
      EXPECT_LE(pose.work.fits, worst.fits);
      EXPECT_LE(pose.work.steps, worst.steps);
      EXPECT_LE(pose.work.marker_steps, worst.marker_steps);
      if (steps_max == 3) most.steps = std::max(most.steps, pose.work.steps);
      EXPECT_TRUE(std::isfinite(pose.covariance.sum() + pose.chi_square +
                                pose.T_camera_tool.translation.sum()));
    }
  }
  EXPECT_EQ(most.steps, refine_work_max(8, {3, 1}).steps);
  EXPECT_EQ(refine_work_max(4, {10, 1}).marker_steps, 80);
  EXPECT_EQ(refine_work_max(5, {10, 0}).fits, 2);
}

TEST(RefinePose, GivesTheSameBitsEverywhere) {
  Random random(10);
  test::BitHash hash;
  for (int trial = 0; trial < 500; ++trial) {
    const Tool tool = trial % 2 == 0 ? test::flat_tool() : test::five_marker_pen();
    const Pose truth = test::tilted_pose(tool, random.within(0, 1), k_place, random);
    auto markers = test::weighted_view(tool, truth, k_skewed, 1, random);
    if (trial % 10 == 1) markers[2].range_m += 0.04;
    PosePrior prior{truth, Matrix6::Identity() * 1e4, tool.tip_m};
    prior.T_camera_tool.translation += random.vector(0.01);
    const RefinedPose pose = refine_pose(markers, tool.tip_m, trial % 3 == 0 ? &prior : nullptr);
    hash.add(pose.T_camera_tool);
    hash.add(pose.chi_square);
    hash.add(pose.other.delta_chi_square);
    for (int i = 0; i < 36; ++i) hash.add(pose.covariance(i));
  }
  EXPECT_EQ(hash.value(), 4880834279034308988u);
}

}  // namespace
}  // namespace glint::refine_pose_test
