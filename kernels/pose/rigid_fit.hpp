// The rigid transform that carries a tool's markers onto their measured places.
//
// What:     means removed, C = 1/n sum y' x'^T = U W V^T, R = U diag(1, 1, det(U V^T)) V^T,
//           t = mean(y) - R mean(x), for a model x and measurements y.
// Cost:     linear in the number of points (12 multiplications each) plus best_rotation.hpp, which
//           takes the same for every matrix: 0.4 us.
// Worst:    coplanar points are fine; points on a line or in one place get a Reason, as do numbers
//           that are not finite.
// Accuracy: the least-squares optimum to rounding (1e-15 of the points' distance from the origin).
//           It weighs all directions alike: where the noise is larger along the ray it is unbiased
//           to first order, but not the most accurate fit.
// Source:   Arun, Huang and Blostein 1987, eq. (11) to (14) (the cross-covariance); Kanatani
//           1994 and Challis 1995, eq. (13), for what keeps det R = +1.
#pragma once

#include <span>

#include "kernels/geometry.hpp"
#include "kernels/nonblocking.hpp"
#include "kernels/reason.hpp"

namespace glint {

struct RigidFit {
  Pose transform;    // T_measured_model: measured ~ transform * model
  double rms_m = 0;  // root of the mean squared distance that is left
  Reason reason =
      Reason::none;  // too_few_markers, degenerate, collinear or out_of_range (not finite)
};

// Points are on a line when the second largest variance is below this part of the largest: the
// lateral spread is then under 1/1000 of the length, 0.1 mm of a 100 mm tool, which is how well
// marker positions are known at all.
inline constexpr double k_collinear_variance_ratio = 1e-6;

// All points within a micrometre of their mean are one point.
inline constexpr double k_coincident_variance_m2 = 1e-12;

// Whether the points fix a rotation: none, too_few_markers (< 3), degenerate, collinear or
// out_of_range (not finite).
[[nodiscard]] Reason rotation_is_fixed_by(std::span<const Vector3> points_m) noexcept
    GLINT_NONBLOCKING;

// Both spans in metres and equally long; point i of one belongs to point i of the other.
[[nodiscard]] RigidFit fit_rigid(std::span<const Vector3> model_m,
                                 std::span<const Vector3> measured_m) noexcept GLINT_NONBLOCKING;

}  // namespace glint
