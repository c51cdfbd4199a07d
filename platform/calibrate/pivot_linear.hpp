// The linear part of pivot calibration: tip and post by reweighted least squares.
#pragma once

#include <span>
#include <vector>

#include "kernels/calibrate/pivot_residual.hpp"

namespace glint {

struct PivotPoint {
  Vector3 lever_m = Vector3::Zero();  // the tip seen from the centre, tool frame
  Vector3 post_m = Vector3::Zero();
};

// Least squares with one weight a sample; the samples' sigmas do not count.
[[nodiscard]] PivotPoint weighted_pivot(std::span<const PivotSample> samples,
                                        std::span<const double> weights);

// Every sample weighs one.
[[nodiscard]] PivotPoint plain_pivot(std::span<const PivotSample> samples);

// The same with Huber's weights, from the median of the distances: deaf to a third of wild samples.
[[nodiscard]] PivotPoint robust_pivot(std::span<const PivotSample> samples);

// R lever + centre - post of one sample.
[[nodiscard]] Vector3 pivot_miss(const PivotSample& sample, const PivotPoint& point);

// The noise of the samples, told apart by its direction: along the lever only the position errs.
struct PivotNoise {
  double position_sigma_m = 0;
  double rotation_sigma_rad = 0;
};
[[nodiscard]] PivotNoise pivot_noise(std::span<const PivotSample> samples, const PivotPoint& point);

// All of it taken for the position's, alike in all directions.
[[nodiscard]] PivotNoise pivot_noise_alike(std::span<const PivotSample> samples,
                                           const PivotPoint& point);

// What a miss's covariance is expected to be: position's alike in all directions, rotation's across
// the lever.
[[nodiscard]] Matrix3 miss_covariance(const PivotSample& sample, const PivotPoint& point);

}  // namespace glint
