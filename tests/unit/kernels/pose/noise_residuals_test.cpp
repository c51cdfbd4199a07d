// Sums of residuals and the noise estimate against their formulas, with all values different.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "kernels/pose/noise_estimate.hpp"
#include "kernels/pose/weighted_fit.hpp"
#include "platform/dense.hpp"
#include "tests/unit/kernels/pose/weighted_scene.hpp"

namespace glint::noise_residuals_test {
namespace {

using test::Random;

constexpr MarkerNoise k_declared{0.0015, 0.1, 253, {250, 260}};

// Residuals of one marker in sigmas: two of the pixel, one of the range.
Vector3 residuals(const WeightedMarker& marker, const Pose& pose) {
  const Vector3 point = pose * marker.model_m;
  const double along = marker.ray.dot(point);
  return {marker.across_first.dot(point) / along, marker.across_second.dot(point) / along,
          (point.norm() - marker.range_m) * marker.per_range_sigma};
}

Pose nudged(const Pose& pose, int parameter, double by) {
  Vector3 turn = Vector3::Zero(), shift = Vector3::Zero();
  (parameter < 3 ? shift : turn)(parameter % 3) = by;
  return {(from_rotation_vector(turn) * pose.rotation).normalized(), pose.translation + shift};
}

// Numerical derivatives and a full matrix: the leverage of a residual is its diagonal element of J
// (J'J)^-1 J'.
MarkerResiduals plain_residuals(const std::vector<WeightedMarker>& markers,
                                const std::vector<MarkerVariance>& variances, const Pose& pose,
                                const MarkerNoise& noise) {
  const auto n = static_cast<Eigen::Index>(markers.size());
  Eigen::MatrixXd jacobian(3 * n, 6);
  for (Eigen::Index i = 0; i < n; ++i) {
    for (int p = 0; p < 6; ++p) {
      const auto& marker = markers[static_cast<std::size_t>(i)];
      const double h = 1e-6;
      jacobian.block<3, 1>(3 * i, p) =
          (residuals(marker, nudged(pose, p, h)) - residuals(marker, nudged(pose, p, -h))) /
          (2 * h);
    }
  }
  const Eigen::MatrixXd transposed = jacobian.transpose();
  const Eigen::MatrixXd hat = jacobian * solve_symmetric(transposed * jacobian, transposed);
  MarkerResiduals out;
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto at = static_cast<std::size_t>(i);
    const Vector3 sigmas = residuals(markers[at], pose);
    const double own[] = {variances[at].xx_px2, variances[at].yy_px2, variances[at].range_m2};
    for (int kind = 0; kind < 3; ++kind) {
      const bool range = kind == 2;
      const double free = 1 - hat(3 * i + kind, 3 * i + kind);
      const double declared =
          range ? std::pow(noise.range_sigma_m, 2) : std::pow(noise.pixel_sigma_px, 2);
      const double weight = std::pow(declared / own[kind], 2);
      const double square = std::min(sigmas(kind) * sigmas(kind), 9 * free) * own[kind];
      ResidualSum& sum = range ? out.range : out.pixel;
      sum.squares += weight * (square - free * std::max(own[kind] - declared, 0.0));
      sum.redundancy += weight * free;
    }
  }
  return out;
}

// Different noise for each marker; one outlier, so that its residuals are clipped.
TEST(NoiseResiduals, AreThoseOfAWholeMatrixOfLeverages) {
  Random random(1);
  for (int trial = 0; trial < 40; ++trial) {
    const Tool tool = test::random_tool(random, 4 + trial % 5);
    const Pose truth = test::tilted_pose(tool, 0.6, {0.1, -0.05, 0.5}, random);
    std::vector<WeightedMarker> markers;
    std::vector<MarkerVariance> variances;
    for (int i = 0; i < tool.marker_count; ++i) {
      const MarkerVariance variance{random.within(0.005, 0.03), 0, random.within(0.005, 0.03),
                                    random.within(1e-6, 9e-6)};
      variances.push_back(variance);
      markers.push_back(
          test::weighted_view(tool, truth, variance, 1, random)[static_cast<std::size_t>(i)]);
    }
    if (trial % 2 == 0) markers[1].range_m += 0.02;
    const WeightedFit fit =
        fit_weighted(markers, mean_of(markers), truth, nullptr, k_refine_steps_max);
    ASSERT_EQ(fit.reason, Reason::none);
    const MarkerResiduals found = residuals_of(markers, variances, fit.T_camera_tool, k_declared);
    const MarkerResiduals plain =
        plain_residuals(markers, variances, fit.T_camera_tool, k_declared);
    EXPECT_NEAR(found.range.redundancy, plain.range.redundancy, 1e-6);
    EXPECT_NEAR(found.pixel.redundancy, plain.pixel.redundancy, 1e-6);
    EXPECT_NEAR(found.range.squares / 1e-6, plain.range.squares / 1e-6, 1e-4);
    EXPECT_NEAR(found.pixel.squares / 1e-2, plain.pixel.squares / 1e-2, 1e-4);
  }
}

// The leverages of all residuals sum to six.
TEST(NoiseResiduals, HaveTheFreedomThatAFitLeaves) {
  Random random(2);
  const Tool tool = test::random_tool(random, 6);
  const Pose truth = test::tilted_pose(tool, 0.6, {0.1, -0.05, 0.5}, random);
  const MarkerVariance alike{0.01, 0, 0.01, 0.0015 * 0.0015};
  const auto markers = test::weighted_view(tool, truth, alike, 0, random);
  const std::vector<MarkerVariance> variances(markers.size(), alike);
  const MarkerResiduals found = residuals_of(markers, variances, truth, k_declared);
  EXPECT_NEAR(found.range.redundancy + found.pixel.redundancy, 3 * 6 - 6, 1e-9);
  EXPECT_NEAR(found.range.squares, 0, 1e-15) << "no residual, no noise of its own";
}

TEST(NoiseResiduals, AreNoneWithoutMarkersAndOfAPoseBehindTheCamera) {
  Random random(3);
  const Tool tool = test::random_tool(random, 6);
  const Pose truth = test::tilted_pose(tool, 0.6, {0.1, -0.05, 0.5}, random);
  const auto markers = test::weighted_view(tool, truth, {}, 1, random);
  const std::vector<MarkerVariance> variances(markers.size());
  const Pose behind{truth.rotation, truth.translation - Vector3(0, 0, 2)};
  for (const MarkerResiduals& none : {residuals_of({}, {}, truth, k_declared),
                                      residuals_of(markers, variances, behind, k_declared)}) {
    EXPECT_EQ(none.range.redundancy, 0);
    EXPECT_EQ(none.range.squares, 0);
    EXPECT_EQ(none.pixel.redundancy, 0);
    EXPECT_EQ(none.pixel.squares, 0);
  }
}

TEST(NoiseEstimate, IsTheWeightedMeanOfTheDeclaredAndTheNewestVariances) {
  const double m2 = 0.0015 * 0.0015, px2 = 0.01;
  NoiseEstimate estimate;
  add({{40 * m2, 12, 0}, {30 * px2, 24, 0}}, k_declared, estimate);
  // The declared noise has eight degrees of freedom, of which new residuals replace their share.
  const double kept_range = 1 - 12.0 / 300, kept_pixel = 1 - 24.0 / 300;
  const double range_1 = (kept_range * 8 + 40) * m2, range_f1 = kept_range * 8 + 12;
  const double pixel_1 = (kept_pixel * 8 + 30) * px2, pixel_f1 = kept_pixel * 8 + 24;
  EXPECT_TRUE(estimate.has_residuals);
  EXPECT_NEAR(estimate.range_sigma_m, std::sqrt(range_1 / range_f1), 1e-15);
  EXPECT_NEAR(estimate.pixel_sigma_px, std::sqrt(pixel_1 / pixel_f1), 1e-13);
  EXPECT_NEAR(estimate.sums.range.declared, kept_range * 8, 1e-12);
  EXPECT_NEAR(estimate.sums.pixel.declared, kept_pixel * 8, 1e-12);
  add({{2 * m2, 6, 0}, {9 * px2, 3, 0}}, k_declared, estimate);
  const double again_range = 1 - 6.0 / 300, again_pixel = 1 - 3.0 / 300;
  EXPECT_NEAR(estimate.sums.range.squares / m2, (again_range * range_1 + 2 * m2) / m2, 1e-9);
  EXPECT_NEAR(estimate.sums.range.redundancy, again_range * range_f1 + 6, 1e-12);
  EXPECT_NEAR(estimate.sums.pixel.squares / px2, (again_pixel * pixel_1 + 9 * px2) / px2, 1e-9);
  EXPECT_NEAR(estimate.sums.pixel.redundancy, again_pixel * pixel_f1 + 3, 1e-12);
  EXPECT_NEAR(estimate.sums.range.declared, again_range * kept_range * 8, 1e-12);
  EXPECT_NEAR(estimate.range_sigma_m,
              std::sqrt(estimate.sums.range.squares / estimate.sums.range.redundancy), 1e-15);
  const MarkerNoise now = noise_now(estimate, k_declared);
  EXPECT_EQ(now.range_sigma_m, estimate.range_sigma_m);
  EXPECT_EQ(now.pixel_sigma_px, estimate.pixel_sigma_px);
  EXPECT_EQ(now.focal_px, 253);
  EXPECT_EQ(now.principal_px, k_declared.principal_px);
}

TEST(NoiseEstimate, ForgetsAllBeforeAMemoryFullOfResiduals) {
  NoiseEstimate estimate;
  for (const double freedom : {300.0, 400.0}) {
    add({{freedom * 4e-6, freedom, 0}, {freedom * 0.09, freedom, 0}}, k_declared, estimate);
    EXPECT_NEAR(estimate.sums.range.redundancy, freedom, 1e-12);
    EXPECT_NEAR(estimate.range_sigma_m, 0.002, 1e-15);
    EXPECT_NEAR(estimate.pixel_sigma_px, 0.3, 1e-13);
    EXPECT_EQ(estimate.sums.range.declared, 0);
    EXPECT_EQ(variance_inflation(estimate, k_declared), 1);
  }
}

// Residuals without redundancy in ranges or in pixels add nothing.
TEST(NoiseEstimate, TakesResidualsOfBothKindsTogether) {
  for (const auto& [range, pixel] : {std::pair{0.0, 5.0}, {5.0, 0.0}, {0.0, 0.0}}) {
    NoiseEstimate estimate;
    add({{1e-6, range, 0}, {0.01, pixel, 0}}, k_declared, estimate);
    EXPECT_FALSE(estimate.has_residuals);
    EXPECT_EQ(estimate.sums.range.redundancy, 0);
    EXPECT_EQ(estimate.sums.pixel.redundancy, 0);
  }
}

TEST(NoiseEstimate, KeepsEachSigmaWithinItsLimits) {
  NoiseEstimate quiet, loud;
  for (int i = 0; i < 30; ++i) {
    add({{-1e-3, 20, 0}, {-1e3, 20, 0}}, k_declared, quiet);
    add({{1e3, 20, 0}, {1e3, 20, 0}}, k_declared, loud);
  }
  EXPECT_DOUBLE_EQ(quiet.range_sigma_m, k_range_sigma_min_m);
  EXPECT_DOUBLE_EQ(quiet.pixel_sigma_px, k_pixel_sigma_min_px);
  EXPECT_DOUBLE_EQ(loud.range_sigma_m, k_range_sigma_max_m);
  EXPECT_DOUBLE_EQ(loud.pixel_sigma_px, k_pixel_sigma_max_px);
}

// The estimate against one that starts with ten times the declared variance at three degrees of
// freedom.
TEST(VarianceDoubt, IsTheLargerOfBothKinds) {
  NoiseEstimate estimate;
  estimate.has_residuals = true;
  estimate.range_sigma_m = 0.003;
  estimate.pixel_sigma_px = 0.05;
  estimate.sums.range = {0, 20, 4};
  estimate.sums.pixel = {0, 9, 2};
  const auto doubt = [](double freedom, double declared, double ratio) {
    const double open = 3 * declared / 8, seen = freedom - declared;
    return (seen + open * 10 * ratio) / (seen + open);
  };
  const double range = doubt(20, 4, 0.25), pixel = doubt(9, 2, 4);
  ASSERT_GT(pixel, range);
  EXPECT_NEAR(variance_inflation(estimate, k_declared), pixel, 1e-12);
  estimate.pixel_sigma_px = 0.3;
  ASSERT_GT(range, doubt(9, 2, 1.0 / 9));
  EXPECT_NEAR(variance_inflation(estimate, k_declared), range, 1e-12);
  estimate.range_sigma_m = 0.01;
  estimate.pixel_sigma_px = 0.9;
  EXPECT_EQ(variance_inflation(estimate, k_declared), 1) << "more than ten times already";
}

}  // namespace
}  // namespace glint::noise_residuals_test
