// Calibration errors (consider parameters) estimated from the residuals of many pose fits.
//
// What:     estimates the parameters c of systematic_covariance.hpp beside each fit's pose, in
//           units of their declared standard deviations. They are range offset and scale, principal
//           point, focal length and each marker's position in the tool. With the residuals f = J dx
//           - C c of a fit and M the projection that removes the pose's part: information += C' M
//           C, pull -= C' M f. The MAP errors under their declared distributions are (1 +
//           information)^-1 pull. Correlated errors and uncalibrated ones (k_lens_residual_px,
//           k_range_ripple_m) inflate the residuals' noise, the latter by the number of
//           neighbouring fits that share them.
// Cost:     for each fit the normal equations, and k_calibration_errors^2 / 2 products per
//           residual.
// Worst:    data independent for a given number of markers.
// Accuracy: first order in the errors and in the pose's distance from the optimum.
// Source:   elimination of the pose by the Schur complement: Triggs et al. 2000, "Bundle adjustment
//           - a modern synthesis", section 6.1.
#pragma once

#include <span>

#include "kernels/limits.hpp"
#include "kernels/nonblocking.hpp"
#include "kernels/pose/local_rays.hpp"
#include "kernels/pose/systematic_covariance.hpp"
#include "kernels/pose/weighted_marker.hpp"
#include "kernels/result.hpp"

namespace glint {

// Order: range offset, range scale, principal point x and y, focal length, then x, y and z of each
// of the tool's markers.
inline constexpr int k_common_errors = 5;
inline constexpr int k_calibration_errors = k_common_errors + 3 * k_markers_per_tool_max;
using ErrorVector = Eigen::Matrix<double, k_calibration_errors, 1>;
using ErrorMatrix = Eigen::Matrix<double, k_calibration_errors, k_calibration_errors>;

inline constexpr double k_lens_residual_px = 0.1, k_range_ripple_m = 0.001;  // 1 sigma

struct CalibrationErrors {
  ErrorMatrix information = ErrorMatrix::Zero();  // lower triangle only
  ErrorVector information_vector = ErrorVector::Zero();
  double ranges_m = 0;  // sum of the markers' mean ranges
  int fits = 0;
};

// The optimum of one fit and its derivatives by the common errors: about the tool's origin and the
// camera's axes, order (x, y, z, rx, ry, rz).
struct OptimalFit {
  Pose T_camera_tool;
  Matrix6 covariance = Matrix6::Zero();  // from noise, correlated and uncalibrated errors
  Eigen::Matrix<double, 6, k_common_errors> by_errors =
      Eigen::Matrix<double, 6, k_common_errors>::Zero();  // per declared sigma
};

// rays: the lens linearised at each marker; of_tool: index of the tool's marker; both in the order
// of `markers`. T_camera_tool: near the fit's optimum. errors: may be null, then nothing is added.
// Adds nothing and returns Reason::degenerate if the markers do not determine the pose, or bad_fit
// if the labeling or the minimum is wrong (no error explains the residuals).
[[nodiscard]] Result<OptimalFit> add_fit(std::span<const WeightedMarker> markers,
                                         std::span<const LocalRays> rays,
                                         std::span<const int> of_tool, const Pose& T_camera_tool,
                                         const CameraUncertainty& camera, double marker_sigma_m,
                                         CalibrationErrors* errors) noexcept GLINT_NONBLOCKING;

}  // namespace glint
