// The normal equations of the weighted fit at one pose.
//
// What:     with the residuals f_k of all markers (weighted_marker.hpp: u, v and range of each):
//           chi_square = sum f_k^2, slope = sum J_k' f_k, matrix = sum J_k' J_k. Parameters: the
//           shift of the markers' mean and a small rotation about it, about the camera's axes; of a
//           residual with the gradient g at a point with the lever r, J = [g', (r x g)'].
// Cost:     three residuals a marker and their products.
// Worst:    none is worse than another.
// Accuracy: exact derivatives of the residuals.
// Source:   Gauss-Newton's equations, e.g. Nocedal and Wright 2006, eq. (10.23).
#pragma once

#include <span>

#include "kernels/geometry.hpp"
#include "kernels/nonblocking.hpp"
#include "kernels/pose/pose_factor.hpp"
#include "kernels/pose/weighted_marker.hpp"

namespace glint {

struct NormalEquations {
  Matrix6 matrix = Matrix6::Zero();  // the lower half holds
  Vector6 slope = Vector6::Zero();
  double chi_square = 0;
};

// mean_m: of the markers, in the tool's frame. False: a marker would lie beside or behind its own
// ray's half of the world, where it has no pixel.
[[nodiscard]] bool add_markers(std::span<const WeightedMarker> markers, const Pose& T_camera_tool,
                               const Vector3& mean_m,
                               NormalEquations& normal) noexcept GLINT_NONBLOCKING;

}  // namespace glint
