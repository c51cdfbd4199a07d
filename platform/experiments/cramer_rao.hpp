// The least covariance that any unbiased estimator of a tool's pose can have.
//
// From the measurement model alone, apart from the estimators that are held to it: pixel and range
// of every marker as functions of the pose, differentiated numerically.
//
// Source: Cramer 1946, Rao 1945: with the Jacobian J of the measurements' mean and their covariance
//         S the bound is (J' S^-1 J)^-1; van Trees 1968, eq. (2.277) with normal noise.
#pragma once

#include "kernels/pose/pose_factor.hpp"
#include "platform/experiments/point_view.hpp"

namespace glint {

// Of (place of the tool's point reference_m, rotation about the camera's axes), all markers seen.
[[nodiscard]] Matrix6 cramer_rao_bound(const Camera& camera, const Tool& tool,
                                       const Pose& T_camera_tool, const Vector3& reference_m,
                                       const SightNoise& noise);

}  // namespace glint
