// Joint fit of a range bias and all poses by Ceres, with noise estimate and covariance.
#pragma once

#include <span>
#include <vector>

#include "kernels/calibrate/depth_residual.hpp"
#include "platform/tools/calibrate/depth.hpp"

namespace glint {

// Markers of one frame; those not kept are ignored.
struct RangedFrame {
  Pose T_camera_tool;
  std::vector<DepthSample> samples;
  std::vector<bool> kept;
};

enum class DepthLoss { cauchy, none };

struct DepthFit {
  Vector3 bias = Vector3::Zero();  // offset_m, per_metre, low_signal_m
  Matrix3 covariance = Matrix3::Zero();
  bool determined = false;
  // Mean square of the residuals, in declared sigmas, divided by their redundancy.
  double pixel_variance = 1, range_variance = 1;
  double variance_inflation = 1;
};

// The frames' poses are the initial guess and receive the result.
[[nodiscard]] DepthFit refined_depth(std::vector<RangedFrame>& frames, const Vector3& start,
                                     Brightness brightness, DepthLoss loss);

}  // namespace glint
