// Rigid fit of a tool's markers to their measured positions: least squares, closed form (absolute
// orientation).
//
// What:     means removed, C = 1/n sum y' x'^T = U W V^T, R = U diag(1, 1, det(U V^T)) V^T, t =
//           mean(y) - R mean(x), for a model x and measurements y.
// Cost:     linear in the number of points (12 multiplications each) plus best_rotation.hpp, which
//           costs the same for every matrix: 0.4 us.
// Worst:    coplanar points are no special case. Points on a line or at one position return a
//           Reason, as do numbers that are not finite.
// Accuracy: the least-squares optimum to rounding (1e-15 of the points' distance from the origin).
//           All directions have equal weight: if the noise is larger along the ray, the fit is
//           unbiased to first order, but not the most accurate one.
// Source:   Arun, Huang and Blostein 1987, eq. (11) to (14) (the cross-covariance); Kanatani 1994
//           and Challis 1995, eq. (13), for the factor that keeps det R = +1.
#pragma once

#include <span>

#include "kernels/geometry.hpp"
#include "kernels/nonblocking.hpp"
#include "kernels/reason.hpp"

namespace glint {

struct RigidFit {
  Pose transform;    // T_measured_model: measured ~ transform * model
  double rms_m = 0;  // root mean square of the residual distances
  Reason reason =
      Reason::none;  // too_few_markers, degenerate, collinear or out_of_range (not finite)
};

// Points are on a line if the second largest variance is below this part of the largest: the
// lateral spread is then under 1/1000 of the length, 0.1 mm for a 100 mm tool, which is the
// accuracy of marker positions.
inline constexpr double k_collinear_variance_ratio = 1e-6;

// Points within a micrometre of their mean coincide.
inline constexpr double k_coincident_variance_m2 = 1e-12;

// Returns none if the points determine a rotation; otherwise too_few_markers (< 3), degenerate,
// collinear or out_of_range (not finite).
[[nodiscard]] Reason rotation_is_fixed_by(std::span<const Vector3> points_m) noexcept
    GLINT_NONBLOCKING;

// Both spans in metres and equally long; point i of one corresponds to point i of the other.
[[nodiscard]] RigidFit fit_rigid(std::span<const Vector3> model_m,
                                 std::span<const Vector3> measured_m) noexcept GLINT_NONBLOCKING;

}  // namespace glint
