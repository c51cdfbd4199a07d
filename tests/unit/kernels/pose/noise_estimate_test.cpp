#include "kernels/pose/noise_estimate.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "kernels/pose/weighted_fit.hpp"
#include "tests/unit/kernels/pose/weighted_scene.hpp"

namespace glint {
namespace {

using test::Random;

MarkerVariance variance_of(const MarkerNoise& noise, const MarkerVariance& own) {
  const double pixel = noise.pixel_sigma_px * noise.pixel_sigma_px;
  return {own.xx_px2 + pixel, 0, own.yy_px2 + pixel,
          own.range_m2 + noise.range_sigma_m * noise.range_sigma_m};
}

// Markers with noise of variance `truth`, weighted with `taken`.
std::vector<WeightedMarker> seen(const Tool& tool, const Pose& pose, const MarkerVariance& truth,
                                 const MarkerVariance& taken, Random& random) {
  std::vector<WeightedMarker> markers = test::weighted_view(tool, pose, truth, 1, random);
  const CameraModel camera = test::pinhole();
  for (WeightedMarker& marker : markers) {
    int steps = 0;
    const LocalRays rays =
        local_rays(camera, project(camera, marker.ray).value, k_ray_steps_max, steps).value;
    marker = whiten_marker(marker.model_m, rays, marker.range_m, taken).value;
  }
  return markers;
}

class NoiseOf : public ::testing::TestWithParam<MarkerNoise> {
 protected:
  static constexpr MarkerNoise k_declared{0.0015, 0.1, 253};

  // Adds a frame of the tool in a random pose. own: variance that each marker states beside the
  // noise of all.
  static void add_frame(const Tool& tool, const MarkerVariance& truth, const MarkerVariance& own,
                        double outlier_m, Random& random, NoiseEstimate& estimate) {
    const MarkerNoise now = noise_now(estimate, k_declared);
    const Pose pose = test::tilted_pose(tool, random.within(0.2, 1.2),
                                        {0.1, -0.05, random.within(0.4, 0.7)}, random);
    const MarkerVariance taken = variance_of(now, own);
    std::vector<WeightedMarker> markers = seen(tool, pose, truth, taken, random);
    markers[0].range_m += outlier_m;
    const WeightedFit fit = fit_weighted(markers, mean_of(markers), pose, nullptr, 20);
    EXPECT_EQ(fit.reason, Reason::none);
    const std::vector<MarkerVariance> variances(markers.size(), taken);
    add(residuals_of(markers, variances, fit.T_camera_tool, now), k_declared, estimate);
  }

  // The estimate after this many frames; each marker also has a known variance of its own.
  static NoiseEstimate after(int frames, const Tool& tool, const MarkerNoise& truth,
                             const MarkerVariance& own, std::uint64_t seed, double outlier_m = 0) {
    Random random(seed);
    NoiseEstimate estimate;
    for (int frame = 0; frame < frames; ++frame) {
      add_frame(tool, variance_of(truth, own), own, frame % 20 == 0 ? outlier_m : 0, random,
                estimate);
    }
    return estimate;
  }
};

TEST_P(NoiseOf, IsFoundByTheResidualsWhateverWasDeclared) {
  const MarkerNoise truth = GetParam();
  double range = 0, pixel = 0;
  constexpr int k_runs = 10;
  for (const bool flat : {true, false}) {
    Random random(3);
    const Tool tool = flat ? test::flat_tool() : test::random_tool(random, 5);
    for (int run = 0; run < k_runs; ++run) {
      const MarkerVariance own{1e-4, 0, 1e-4, 2.5e-7};
      const NoiseEstimate found = after(900, tool, truth, own, 100 + run);
      range += found.range_sigma_m / (2 * k_runs);
      pixel += found.pixel_sigma_px / (2 * k_runs);
    }
  }
  std::printf("  range %.2f mm, pixel %.3f px\n", 1e3 * range, pixel);
  // Mean of ten runs, each with a sigma within 4 %; the declared value has hardly any weight left.
  EXPECT_NEAR(range, truth.range_sigma_m, 0.06 * truth.range_sigma_m);
  EXPECT_NEAR(pixel, truth.pixel_sigma_px, 0.06 * truth.pixel_sigma_px);
}

INSTANTIATE_TEST_SUITE_P(Residuals, NoiseOf,
                         ::testing::Values(MarkerNoise{0.0006, 0.04}, MarkerNoise{0.0006, 0.3},
                                           MarkerNoise{0.0015, 0.1}, MarkerNoise{0.003, 0.04},
                                           MarkerNoise{0.005, 0.1}, MarkerNoise{0.005, 0.3},
                                           MarkerNoise{0.012, 0.04}));

class NoiseEstimateTest : public NoiseOf {};

TEST_F(NoiseEstimateTest, GrowsWithinASecondToThreeTimesTheDeclared) {
  const NoiseEstimate found = after(30, test::flat_tool(), {0.005, 0.1}, {}, 7);
  EXPECT_GT(found.range_sigma_m, 0.0035);
}

TEST_F(NoiseEstimateTest, IsHardlyMovedByAMarkerThatIsFarOff) {
  Random random(3);
  const NoiseEstimate found =
      after(900, test::random_tool(random, 6), {0.0015, 0.1}, {1e-4, 0, 1e-4, 2.5e-7}, 8, 0.05);
  EXPECT_LT(found.range_sigma_m, 0.0015 * 1.3);
}

// As far away and partly occluded markers do, for whole seconds.
TEST_F(NoiseEstimateTest, IsKeptByMarkersThatOverstateTheirOwnVariance) {
  Random random(3);
  const Tool tool = test::random_tool(random, 5);
  NoiseEstimate estimate;
  for (int frame = 0; frame < 300; ++frame) {
    const MarkerVariance own = frame < 150 ? MarkerVariance{} : MarkerVariance{0.3, 0, 0.3, 1e-4};
    add_frame(tool, variance_of(k_declared, {}), own, 0, random, estimate);
  }
  EXPECT_NEAR(estimate.range_sigma_m, k_declared.range_sigma_m, 0.2 * k_declared.range_sigma_m);
  EXPECT_NEAR(estimate.pixel_sigma_px, k_declared.pixel_sigma_px, 0.2 * k_declared.pixel_sigma_px);
}

TEST_F(NoiseEstimateTest, StaysWithinItsLimits) {
  const NoiseEstimate quiet =
      after(2000, test::flat_tool(), {1e-6, 1e-4}, {1e-6, 0, 1e-6, 1e-10}, 9);
  EXPECT_GE(quiet.range_sigma_m, k_range_sigma_min_m);
  EXPECT_GE(quiet.pixel_sigma_px, k_pixel_sigma_min_px);
  NoiseEstimate loud;
  for (int i = 0; i < 1000; ++i) add({{1e3, 1}, {1e3, 1}}, k_declared, loud);
  EXPECT_EQ(loud.range_sigma_m, k_range_sigma_max_m);
  EXPECT_EQ(loud.pixel_sigma_px, k_pixel_sigma_max_px);
}

// A true sigma of five times the declared one needs as many residuals as the declared one.
TEST_F(NoiseEstimateTest, DoubtsTheDeclaredNoiseUntilThereAreResiduals) {
  EXPECT_EQ(variance_inflation({}, k_declared), k_noise_variance_inflation);
  const MarkerNoise loud{5 * k_declared.range_sigma_m, 5 * k_declared.pixel_sigma_px};
  for (const MarkerNoise& truth : {k_declared, loud}) {
    double doubt = k_noise_variance_inflation;
    for (const int frames : {1, 5, 30, 900}) {
      const NoiseEstimate found = after(frames, test::flat_tool(), truth, {}, 9);
      const double now = variance_inflation(found, k_declared);
      EXPECT_GE(now, 1);
      EXPECT_LE(now, 1.3 * doubt) << frames;
      doubt = now;
    }
    EXPECT_NEAR(doubt, 1, 0.01);
  }
}

// After few residuals of the declared size the factor stays large; after many it is near one.
TEST_F(NoiseEstimateTest, LosesItsDoubtByDegrees) {
  const double m2 = k_declared.range_sigma_m * k_declared.range_sigma_m;
  const double px2 = k_declared.pixel_sigma_px * k_declared.pixel_sigma_px;
  double before = k_noise_variance_inflation;
  for (const double freedom : {1.0, 5.0, 40.0}) {
    NoiseEstimate estimate;
    add({{freedom * m2, freedom}, {freedom * px2, freedom}}, k_declared, estimate);
    ASSERT_TRUE(estimate.has_residuals);
    const double doubt = variance_inflation(estimate, k_declared);
    EXPECT_GT(doubt, 1) << freedom;
    EXPECT_LT(doubt, before) << freedom;
    before = doubt;
  }
  EXPECT_LT(before, 2);
}

TEST_F(NoiseEstimateTest, LearnsNothingFromMarkersThatFixNoPose) {
  const std::vector<WeightedMarker> one(1);
  const MarkerResiduals found =
      residuals_of(one, std::vector<MarkerVariance>(1), Pose{}, k_declared);
  EXPECT_EQ(found.range.redundancy, 0);
  EXPECT_EQ(found.pixel.redundancy, 0);
  NoiseEstimate estimate;
  add(found, k_declared, estimate);
  EXPECT_FALSE(estimate.has_residuals);
  EXPECT_EQ(noise_now(estimate, k_declared).range_sigma_m, k_declared.range_sigma_m);
}

}  // namespace
}  // namespace glint
