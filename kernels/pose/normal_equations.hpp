// Normal equations of the weighted pose fit at one pose (Gauss-Newton).
//
// What:     with the residuals f_k of all markers (weighted_marker.hpp: u, v and range of each):
//           chi_square = sum f_k^2, slope = sum J_k' f_k, matrix = sum J_k' J_k. Parameters: the
//           translation of the markers' mean and a small rotation about it, along the camera's
//           axes. For a residual with the gradient g at a point with the lever r, J = [g', (r x
//           g)'].
// Cost:     three residuals per marker and their products.
// Worst:    data independent.
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
  Matrix6 matrix = Matrix6::Zero();  // lower triangle only
  Vector6 gradient = Vector6::Zero();
  double chi_square = 0;
};

// mean_m: of the markers, tool frame. Returns false if a marker's depth along its measured ray is
// negative or less than a tenth of the measured range, where it has no valid pixel.
[[nodiscard]] bool add_markers(std::span<const WeightedMarker> markers, const Pose& T_camera_tool,
                               const Vector3& mean_m,
                               NormalEquations& normal) noexcept GLINT_NONBLOCKING;

}  // namespace glint
