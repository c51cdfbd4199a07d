// A tool's pose from where its markers are seen: the simple reference for experiments that need a
// weighted measurement with its covariance, not a camera's frames.
//
// What: least squares of (u, v, range) by Gauss and Newton with a numeric Jacobian, from the rigid
//       fit of the back-projected points; covariance (J'WJ)^-1.
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

// (u, v, range) of a point in the camera's frame; u and v from the principal point.
[[nodiscard]] Vector3 seen_at(const PointCamera& camera, const Vector3& point_m);

// model_m: the markers about their own middle, so that the pose is the middle's.
[[nodiscard]] Result<UncertainPose> fit_points(const PointCamera& camera,
                                               const std::vector<Vector3>& model_m,
                                               const std::vector<Vector3>& seen);

// NDI 8700339's four markers about their middle; exactly in one plane, x = 0.
[[nodiscard]] std::vector<Vector3> tool_8700339();

}  // namespace glint
