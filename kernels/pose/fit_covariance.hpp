// Covariance of a rigid fit's pose, from the declared noise of its markers.
//
// What:     cov(x) = H^-1 (sum J_i' S_i J_i) H^-1, H = sum J_i' J_i, J_i = [I, -[p_i -
//           reference]x]: the noise S_i of each marker, propagated through the unweighted
//           least-squares fit.
// Cost:     linear in the markers (0.1 us each) plus a 6x6 Cholesky inverse: 1 us.
// Worst:    markers on a line: Reason::collinear.
// Accuracy: first order in the noise: within 10 % of 20,000 simulated fits at 1.5 mm along the ray.
// Source:   covariance of least squares whose weights differ from the noise, e.g. Foerstner and
//           Wrobel 2016, Photogrammetric Computer Vision, eq. (4.50); the Jacobian of a small
//           rotation dtheta about fixed axes, p -> p + dtheta x p.
#pragma once

#include <span>

#include "kernels/geometry.hpp"
#include "kernels/nonblocking.hpp"
#include "kernels/result.hpp"

namespace glint {

// Covariance of a marker seen along `ray` (unit): one sigma along it, another across it, in metres.
[[nodiscard]] Matrix3 marker_covariance(const Vector3& ray, double along_sigma_m,
                                        double across_sigma_m) noexcept GLINT_NONBLOCKING;

// points_m: the fitted markers in the measured frame; covariances_m2: theirs, in the same order.
// reference_m: the tool's point (the tip), in the same frame, to which the covariance refers. Order
// (x, y, z, rx, ry, rz): metres, and radians about the frame's fixed axes. Reason: too_few_markers
// (< 3, or unequal spans), degenerate, collinear, out_of_range (not finite).
[[nodiscard]] Result<Matrix6> fit_covariance(std::span<const Vector3> points_m,
                                             std::span<const Matrix3> covariances_m2,
                                             const Vector3& reference_m) noexcept GLINT_NONBLOCKING;

}  // namespace glint
