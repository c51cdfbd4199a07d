// A depth bias and all poses at once, by Ceres; and what the residuals say of noise and certainty.
#pragma once

#include <span>
#include <vector>

#include "kernels/calibrate/depth_residual.hpp"
#include "platform/calibrate/depth.hpp"

namespace glint {

// One frame's markers. Those not kept have no say.
struct RangedFrame {
  Pose T_camera_tool;
  std::vector<DepthSample> samples;
  std::vector<bool> kept;
};

enum class DepthLoss { cauchy, none };

struct DepthFit {
  Vector3 bias = Vector3::Zero();  // offset_m, per_metre, dim_m
  Matrix3 covariance = Matrix3::Zero();
  bool determined = false;
  // Mean square of the residuals, in declared sigmas, over their redundancy.
  double pixel_variance = 1, range_variance = 1;
  double correlated = 1;
};

// The frames' poses are the start and become the result's.
[[nodiscard]] DepthFit refined_depth(std::vector<RangedFrame>& frames, const Vector3& start,
                                     Brightness brightness, DepthLoss loss);

}  // namespace glint
