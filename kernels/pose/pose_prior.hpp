// Gaussian prior of a tool's pose for a weighted fit: a predicted pose and its information matrix.
//
// What:     adds the deviation of a pose from the prediction, weighted by the prediction's
//           information matrix, to a fit's normal equations.
// Cost:     a rotation vector and a few 6x6 products.
// Worst:    data independent.
// Accuracy: the derivative of the rotation vector to the third order of its angle.
// Source:   J_l^-1 (phi) = I - [phi]x / 2 + [phi]x^2 / 12 - ..: Barfoot 2017, State Estimation for
//           Robotics, eq. (7.76b), with the series of its last factor.
#pragma once

#include "kernels/geometry.hpp"
#include "kernels/nonblocking.hpp"
#include "kernels/pose/normal_equations.hpp"

namespace glint {

// information: the inverse of the covariance of (reference position, rotation about the camera
// frame's fixed axes) in metres and radians, symmetric; as in fit_covariance.hpp.
struct PosePrior {
  Pose T_camera_tool;
  Matrix6 information = Matrix6::Zero();
  Vector3 reference_m = Vector3::Zero();  // tool frame: the predicted point, the tip
};

// Parameters as in normal_equations.hpp, about mean_m of the tool's frame.
void add_prior(const PosePrior& prior, const Pose& T_camera_tool, const Vector3& mean_m,
               NormalEquations& normal) noexcept GLINT_NONBLOCKING;

}  // namespace glint
