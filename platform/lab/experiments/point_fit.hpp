// Reference fit of a tool's pose, with covariance, to marker observations (u, v, range), for
// experiments at point level without camera frames.
//
// What:     least squares of (u, v, range) by Gauss-Newton with a numeric Jacobian. Initial guess:
//           the rigid fit of the back-projected points. Covariance (J'WJ)^-1.
#pragma once

#include <cstdint>
#include <vector>

#include "kernels/motion/motion_state.hpp"
#include "kernels/result.hpp"

namespace glint {

struct PointCamera {
  double focal_px = 253;
  double pixel_sigma_px = 0.1;
  double range_sigma_m = 0.001;
};

// Returns (u, v, range) of a point in the camera frame; u and v from the principal point.
[[nodiscard]] Vector3 seen_at(const PointCamera& camera, const Vector3& point_m);

// model_m: the markers relative to their mean, so that the pose is that of the mean.
[[nodiscard]] Result<UncertainPose> fit_points(const PointCamera& camera,
                                               const std::vector<Vector3>& model_m,
                                               const std::vector<Vector3>& seen);

// The four markers of NDI 8700339 relative to their mean; exactly in the plane x = 0.
[[nodiscard]] std::vector<Vector3> tool_8700339();

}  // namespace glint
