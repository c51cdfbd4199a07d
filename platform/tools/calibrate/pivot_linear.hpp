// Linear pivot calibration: tip and post by iteratively reweighted least squares.
#pragma once

#include <span>
#include <vector>

#include "kernels/calibrate/pivot_residual.hpp"

namespace glint {

struct PivotPoint {
  Vector3 lever_m = Vector3::Zero();  // from the centre to the tip, tool frame
  Vector3 post_m = Vector3::Zero();
};

// Least squares with one weight per sample; ignores the samples' sigmas.
[[nodiscard]] PivotPoint weighted_pivot(std::span<const PivotSample> samples,
                                        std::span<const double> weights);

// Least squares with unit weights.
[[nodiscard]] PivotPoint unweighted_pivot(std::span<const PivotSample> samples);

// Least squares with Huber weights scaled by the median distance; resists a third of outliers.
[[nodiscard]] PivotPoint robust_pivot(std::span<const PivotSample> samples);

// R lever + centre - post of one sample.
[[nodiscard]] Vector3 pivot_residual_of(const PivotSample& sample, const PivotPoint& point);

// Noise of the samples, separated by direction: along the lever arm only position noise acts.
struct PivotNoise {
  double position_sigma_m = 0;
  double rotation_sigma_rad = 0;
};
[[nodiscard]] PivotNoise pivot_noise(std::span<const PivotSample> samples, const PivotPoint& point);

// Attributes all noise to the position, isotropic.
[[nodiscard]] PivotNoise isotropic_pivot_noise(std::span<const PivotSample> samples,
                                               const PivotPoint& point);

// Expected covariance of a pivot_residual_of: isotropic position noise, and rotation noise across
// the lever arm.
[[nodiscard]] Matrix3 residual_covariance(const PivotSample& sample, const PivotPoint& point);

}  // namespace glint
