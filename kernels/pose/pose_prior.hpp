// What is known of a tool's pose before its markers are looked at: a prediction and how sure it is.
//
// What:     of a pose, its distance from the prediction in the prediction's own noise, added to a
//           fit's normal equations.
// Cost:     a rotation vector and a few 6x6 products.
// Worst:    none is worse than another.
// Accuracy: the change of the rotation vector to the third order of its angle.
// Source:   J_l^-1 (phi) = I - [phi]x / 2 + [phi]x^2 / 12 - ..: Barfoot 2017, State Estimation for
//           Robotics, eq. (7.76b), with the series of its last factor.
#pragma once

#include "kernels/geometry.hpp"
#include "kernels/nonblocking.hpp"
#include "kernels/pose/normal_equations.hpp"

namespace glint {

// information: the inverse of the covariance of (the reference's place, rotation about the camera
// frame's fixed axes) in metres and radians, symmetric; as in fit_covariance.hpp.
struct PosePrior {
  Pose T_camera_tool;
  Matrix6 information = Matrix6::Zero();
  Vector3 reference_m = Vector3::Zero();  // tool frame: the point whose place is known, the tip
};

// The pose's parameters are as in normal_equations.hpp, about mean_m of the tool's frame.
void add_prior(const PosePrior& prior, const Pose& T_camera_tool, const Vector3& mean_m,
               NormalEquations& normal) noexcept GLINT_NONBLOCKING;

}  // namespace glint
