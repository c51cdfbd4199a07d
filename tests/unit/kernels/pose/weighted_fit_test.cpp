// Parts of the weighted fit, each against its definition.
#include "kernels/pose/weighted_fit.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "kernels/pose/chi_square_limit.hpp"
#include "kernels/pose/depth_flip.hpp"
#include "kernels/pose/lever_arm.hpp"
#include "kernels/pose/normal_equations.hpp"
#include "kernels/pose/rigid_fit.hpp"
#include "tests/unit/kernels/pose/weighted_scene.hpp"

namespace glint::weighted_fit_test {
namespace {

const Vector3 k_place(0.08, -0.05, 0.5);
const MarkerVariance k_skewed{0.01, 0.004, 0.0064, 0.002 * 0.002};

Matrix6 random_positive(test::Random& random) {
  Matrix6 root;
  for (int i = 0; i < 36; ++i) root(i) = random.normal();
  return root * root.transpose() + 0.1 * Matrix6::Identity();
}

TEST(PoseFactor, SolvesAndInvertsWhatIsPositive) {
  test::Random random(1);
  for (int trial = 0; trial < 200; ++trial) {
    const Matrix6 matrix = random_positive(random);
    const Result<PoseFactor> factor = pose_factor(matrix);
    ASSERT_TRUE(factor);
    EXPECT_LT((matrix * factor.value.inverse() - Matrix6::Identity()).norm(), 1e-10);
    Vector6 b;
    for (int i = 0; i < 6; ++i) b(i) = random.normal();
    EXPECT_LT((matrix * factor.value.solve(b) - b).norm(), 1e-10);
  }
}

TEST(PoseFactor, SaysWhenAMatrixIsNotPositive) {
  Matrix6 matrix = Matrix6::Identity();
  matrix(4, 4) = 0;
  EXPECT_EQ(pose_factor(matrix).reason, Reason::degenerate);
  matrix(4, 4) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(pose_factor(matrix).reason, Reason::degenerate);
  matrix(4, 4) = std::numeric_limits<double>::infinity();
  EXPECT_EQ(pose_factor(matrix).reason, Reason::degenerate);
}

TEST(ChiSquareLimit, IsTheTextbooksAndGrows) {
  EXPECT_NEAR(chi_square_limit(2), 18.4207, 1e-4);  // -2 ln 1e-4
  for (int degrees = 1; degrees <= 24; ++degrees) {
    EXPECT_GT(chi_square_limit(degrees), chi_square_limit(degrees - 1));
  }
  EXPECT_EQ(chi_square_limit(99), chi_square_limit(24));
}

// One pixel to the right, sigma 0.2 px along that axis; the range is 2 sigmas short.
TEST(WeightedMarker, CountsInSigmasOfThePixelAndTheRange) {
  const CameraModel camera = test::pinhole();
  int lens_steps = 0;
  const LocalRays rays = local_rays(camera, {256, 256}, k_ray_steps_max, lens_steps).value;
  const auto marker = whiten_marker(Vector3::Zero(), rays, 0.5, {0.04, 0, 0.01, 0.003 * 0.003});
  ASSERT_TRUE(marker);
  const Vector3 right(0.5 / 253, 0, 0.5), below(0, 0.5 / 253, 0.5);
  EXPECT_NEAR(marker.value.across_first.dot(right) / 0.5, 5, 1e-9);
  EXPECT_NEAR(marker.value.across_second.dot(right) / 0.5, 0, 1e-9);
  EXPECT_NEAR(marker.value.across_second.dot(below) / 0.5, 10, 1e-9);
  EXPECT_NEAR(marker.value.per_range_sigma * 0.006, 2, 1e-9);
}

TEST(WeightedMarker, RefusesNoiseAndRangesThatAreNone) {
  const LocalRays rays{{256, 256}, {0, 0, 1}, {0.004, 0, 0}, {0, 0.004, 0}};
  const LocalRays flat{{256, 256}, {0, 0, 1}, {0.004, 0, 0}, {0.004, 0, 0}};
  const Vector3 model(0, 0, 0.1);
  const double none = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(whiten_marker(model, rays, 0.5, {}));
  EXPECT_EQ(whiten_marker(model, rays, 0.5, {0, 0, 0.01, 1e-6}).reason, Reason::out_of_range);
  EXPECT_EQ(whiten_marker(model, rays, 0.5, {0.01, 0.01, 0.01, 1e-6}).reason, Reason::out_of_range);
  EXPECT_EQ(whiten_marker(model, rays, 0.5, {0.01, 0, 0.01, 0}).reason, Reason::out_of_range);
  EXPECT_EQ(whiten_marker(model, rays, -0.5, {}).reason, Reason::out_of_range);
  EXPECT_EQ(whiten_marker(model, rays, none, {}).reason, Reason::out_of_range);
  EXPECT_EQ(whiten_marker(model, flat, 0.5, {}).reason, Reason::out_of_range);
  EXPECT_EQ(whiten_marker({none, 0, 0}, rays, 0.5, {}).reason, Reason::out_of_range);
}

// The pose after a small change of the fit's six parameters.
Pose nudged(const Pose& pose, const Vector3& mean_m, int parameter, double by) {
  Vector3 rotation = Vector3::Zero(), translation = Vector3::Zero();
  (parameter < 3 ? translation : rotation)(parameter % 3) = by;
  const Vector3 mean = pose * mean_m + translation;
  Pose out;
  out.rotation = from_rotation_vector(rotation) * pose.rotation;
  out.translation = mean - out.rotation * mean_m;
  return out;
}

NormalEquations equations_at(const std::vector<WeightedMarker>& markers, const Vector3& mean_m,
                             const Pose& pose, const PosePrior* prior) {
  NormalEquations normal;
  EXPECT_TRUE(add_markers(markers, pose, mean_m, normal));
  if (prior != nullptr) add_prior(*prior, pose, mean_m, normal);
  return normal;
}

PosePrior prior_near(const Pose& pose, const Tool& tool, double turned_rad, test::Random& random) {
  PosePrior prior;
  prior.information = 1e4 * random_positive(random);
  prior.reference_m = tool.tip_m + Vector3(0.01, 0.02, -0.15);
  prior.T_camera_tool = {
      from_rotation_vector(turned_rad * Vector3(0.6, -0.64, 0.48)) * pose.rotation,
      pose.translation + Vector3(0.004, -0.002, 0.01)};
  return prior;
}

TEST(NormalEquations, SlopeIsHalfTheGradientOfChiSquareWithAndWithoutAPrior) {
  test::Random random(2);
  const Tool tool = test::five_marker_pen();
  const Vector3 mean = test::mean_of_markers(tool);
  for (int trial = 0; trial < 40; ++trial) {
    const Pose pose = test::tilted_pose(tool, random.within(0, 1), k_place, random);
    const auto markers = test::weighted_view(tool, pose, k_skewed, 3, random);
    const PosePrior near = prior_near(pose, tool, 0.1, random);
    const PosePrior* const prior = trial % 2 == 0 ? nullptr : &near;
    const NormalEquations normal = equations_at(markers, mean, pose, prior);
    for (int i = 0; i < 6; ++i) {
      const double h = 1e-6;
      const double up = equations_at(markers, mean, nudged(pose, mean, i, h), prior).chi_square;
      const double down = equations_at(markers, mean, nudged(pose, mean, i, -h), prior).chi_square;
      const double scale = std::sqrt(normal.matrix(i, i) * normal.chi_square);
      EXPECT_NEAR((up - down) / (4 * h), normal.gradient(i), 2e-4 * scale) << trial << " " << i;
    }
  }
}

TEST(NormalEquations, MatrixIsHalfTheHessianWhereNothingIsLeft) {
  test::Random random(3);
  const Tool tool = test::five_marker_pen();
  const Vector3 mean = test::mean_of_markers(tool);
  const Pose pose = test::tilted_pose(tool, 0.4, k_place, random);
  const auto markers = test::weighted_view(tool, pose, k_skewed, 0, random);
  const Matrix6 matrix =
      equations_at(markers, mean, pose, nullptr).matrix.selfadjointView<Eigen::Lower>();
  const double h = 1e-5;
  for (int i = 0; i < 6; ++i) {
    const Vector6 up = equations_at(markers, mean, nudged(pose, mean, i, h), nullptr).gradient;
    const Vector6 down = equations_at(markers, mean, nudged(pose, mean, i, -h), nullptr).gradient;
    for (int j = 0; j < 6; ++j) {
      const double scale = std::sqrt(matrix(i, i) * matrix(j, j));
      EXPECT_NEAR((up(j) - down(j)) / (2 * h), matrix(i, j), 1e-5 * scale) << i << " " << j;
    }
  }
}

TEST(NormalEquations, HaveNoPixelForAPointBehindTheCamera) {
  test::Random random(4);
  const Tool tool = test::five_marker_pen();
  const Pose pose = test::tilted_pose(tool, 0.4, k_place, random);
  const auto markers = test::weighted_view(tool, pose, k_skewed, 0, random);
  NormalEquations normal;
  const Pose behind{pose.rotation, pose.translation - Vector3(0, 0, 1)};
  EXPECT_FALSE(add_markers(markers, behind, test::mean_of_markers(tool), normal));
}

TEST(DepthFlip, KeepsTheOutlineOfAFlatToolAndTurnsItByTwiceTheTilt) {
  test::Random random(5);
  const Tool tool = test::flat_tool();
  const Vector3 mean = test::mean_of_markers(tool);
  const Vector3 place(0, 0, 0.5);
  for (const double tilt : {0.0, 0.2, 0.5, 1.0}) {
    const Pose pose = test::tilted_pose(tool, tilt, place, random);
    const auto markers = test::weighted_view(tool, pose, {}, 0, random);
    const Vector3 flattest = flattest_direction(markers, mean);
    EXPECT_NEAR(std::abs(flattest.x()), 1, 1e-12);
    const Pose flip = depth_flipped(pose, flattest, mean);
    EXPECT_NEAR(test::angle_between(flip.rotation, pose.rotation), 2 * tilt, 1e-7);
    for (std::size_t i = 0; i < 4; ++i) {
      const Vector3 here = pose * tool.markers_m[i], there = flip * tool.markers_m[i];
      EXPECT_LT((here - there).head<2>().norm(), 1e-12);
      EXPECT_NEAR(here.z() + there.z(), 2 * place.z(), 1e-12);
    }
  }
}

TEST(DepthFlip, FindsTheFlattestDirectionOfAToolThatIsNotFlat) {
  test::Random random(6);
  const Tool tool = test::tool_of<4>({{-67.31, -11.72, 6.78},
                                      {-20.54, 23.63, 21.43},
                                      {20.49, -2.86, -6.55},
                                      {67.36, -9.05, -21.66}});
  const Pose pose = test::tilted_pose(tool, 0.3, k_place, random);
  const auto markers = test::weighted_view(tool, pose, {}, 0, random);
  const Vector3 mean = test::mean_of_markers(tool);
  const Vector3 flattest = flattest_direction(markers, mean);
  EXPECT_NEAR(flattest.norm(), 1, 1e-12);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_NEAR(flattest.dot(tool.markers_m[i] - mean), 0, 1e-4);
  }
}

TEST(WeightedFit, FindsThePoseOfExactMarkersFromFarAway) {
  test::Random random(7);
  const Tool tool = test::five_marker_pen();
  const Vector3 mean = test::mean_of_markers(tool);
  for (int trial = 0; trial < 500; ++trial) {
    const Pose truth = test::tilted_pose(tool, random.within(0, 1.2), k_place, random);
    const auto markers = test::weighted_view(tool, truth, k_skewed, 0, random);
    const Pose start{from_rotation_vector(random.vector(0.15)) * truth.rotation,
                     truth.translation + random.vector(0.02)};
    const WeightedFit fit = fit_weighted(markers, mean, start, nullptr, k_refine_steps_max);
    ASSERT_EQ(fit.reason, Reason::none);
    EXPECT_LT(fit.chi_square, 1e-3);
    EXPECT_LT((fit.T_camera_tool * mean - truth * mean).norm(), 1e-6);
    EXPECT_LT(test::angle_between(fit.T_camera_tool.rotation, truth.rotation), 1e-5);
    EXPECT_LT(fit.steps, k_refine_steps_max);
  }
}

// Against a second fit that starts from the converged pose.
TEST(WeightedFit, EndsWithinAHundredthOfASigma) {
  test::Random random(12);
  double worst = 0;
  for (const Tool& tool : {test::five_marker_pen(), test::flat_tool()}) {
    const Vector3 mean = test::mean_of_markers(tool);
    for (int trial = 0; trial < 500; ++trial) {
      const Pose truth = test::tilted_pose(tool, random.within(0.3, 1.2), k_place, random);
      const auto markers = test::weighted_view(tool, truth, k_skewed, 1, random);
      const Pose start{from_rotation_vector(random.vector(0.05)) * truth.rotation,
                       truth.translation + random.vector(0.005)};
      const WeightedFit fit = fit_weighted(markers, mean, start, nullptr, k_refine_steps_max);
      WeightedFit rest = fit;
      for (int again = 0; again < 3; ++again)
        rest = fit_weighted(markers, mean, rest.T_camera_tool, nullptr, k_refine_steps_max);
      Vector6 apart;
      apart << fit.T_camera_tool * mean - rest.T_camera_tool * mean,
          rotation_vector(fit.T_camera_tool.rotation * rest.T_camera_tool.rotation.conjugate());
      const Matrix6 information = rest.information.selfadjointView<Eigen::Lower>();
      worst = std::max(worst, apart.dot(information * apart));
      EXPECT_NEAR(fit.chi_square, rest.chi_square, 1e-3);
    }
  }
  EXPECT_LT(std::sqrt(worst), 0.01);
}

// A fit that ends early would have converged slowly to the known pose, or stayed as bad.
TEST(WeightedFit, GivesUpWhereAStartLeadsNowhereNear) {
  test::Random random(13);
  const Tool tool = test::five_marker_pen();
  const Vector3 mean = test::mean_of_markers(tool);
  constexpr double k_chi_square_abort = 1000;
  int given_up = 0;
  for (int trial = 0; trial < 300; ++trial) {
    const Pose truth = test::tilted_pose(tool, random.within(0, 1.2), k_place, random);
    const auto markers = test::weighted_view(tool, truth, k_skewed, 1, random);
    const Pose flip = depth_flipped(truth, flattest_direction(markers, mean), mean);
    const WeightedFit fit =
        fit_weighted(markers, mean, flip, nullptr, k_refine_steps_max, k_chi_square_abort);
    const WeightedFit whole = fit_weighted(markers, mean, flip, nullptr, k_refine_steps_max);
    if (fit.reason != Reason::bad_fit) {
      EXPECT_EQ(fit.chi_square, whole.chi_square);
      continue;
    }
    ++given_up;
    EXPECT_EQ(fit.steps, k_steps_before_limit);
    const double off = test::angle_between(whole.T_camera_tool.rotation, truth.rotation);
    EXPECT_TRUE(whole.chi_square > k_chi_square_abort / 2 || off < 0.05)
        << whole.chi_square << " " << off;
  }
  EXPECT_GT(given_up, 150);
}

TEST(WeightedFit, NeverEndsHigherThanAStepBefore) {
  test::Random random(8);
  const Tool tool = test::flat_tool();
  const Vector3 mean = test::mean_of_markers(tool);
  for (int trial = 0; trial < 500; ++trial) {
    const Pose truth = test::tilted_pose(tool, random.within(0, 1.2), k_place, random);
    const auto markers = test::weighted_view(tool, truth, k_skewed, 2, random);
    const Pose start{random.rotation() * truth.rotation, truth.translation + random.vector(0.05)};
    NormalEquations before;
    if (!add_markers(markers, start, mean, before)) continue;
    double least = before.chi_square;
    for (int steps = 1; steps <= k_refine_steps_max; ++steps) {
      const WeightedFit fit = fit_weighted(markers, mean, start, nullptr, steps);
      EXPECT_LE(fit.chi_square, least);
      EXPECT_LE(fit.steps, steps);
      least = fit.chi_square;
    }
  }
}

TEST(WeightedFit, SaysWhenMarkersAndPriorDoNotFixThePose) {
  test::Random random(9);
  const Tool tool = test::flat_tool();
  const Vector3 mean = test::mean_of_markers(tool);
  const Pose truth = test::tilted_pose(tool, 0.5, k_place, random);
  auto markers = test::weighted_view(tool, truth, k_skewed, 0, random);
  PosePrior prior{truth, Matrix6::Zero(), Vector3::Zero()};
  markers.resize(1);
  EXPECT_EQ(fit_weighted(markers, mean, truth, &prior, 5).reason, Reason::degenerate);
  prior.information.diagonal().setConstant(1e4);
  EXPECT_EQ(fit_weighted(markers, mean, truth, &prior, 5).reason, Reason::none);
  prior.T_camera_tool.translation.x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(fit_weighted(markers, mean, truth, &prior, 5).reason, Reason::degenerate);
}

}  // namespace
}  // namespace glint::weighted_fit_test
