// Cramer-Rao bound of a tool's pose: the least covariance of any unbiased estimator.
//
// Derived from the measurement model alone, independent of the estimators that it judges: pixel and
// range of every marker as functions of the pose, differentiated numerically.
//
// Source: Cramer 1946, Rao 1945: with the Jacobian J of the measurements' mean and their covariance
//         S the bound is (J' S^-1 J)^-1; van Trees 1968, eq. (2.277) with normal noise.
#pragma once

#include "kernels/pose/pose_factor.hpp"
#include "platform/lab/experiments/point_view.hpp"

namespace glint {

// Covariance of (position of the tool's point reference_m, rotation about the camera's axes), with
// all markers visible.
[[nodiscard]] Matrix6 cramer_rao_bound(const Camera& camera, const Tool& tool,
                                       const Pose& T_camera_tool, const Vector3& reference_m,
                                       const ObservationNoise& noise);

}  // namespace glint
