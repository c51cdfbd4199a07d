// Which calibration errors the residuals of many fits point to.
//
// What:     the parameters c of systematic_covariance.hpp (range offset and scale, principal point,
//           focal length, each marker's place in the tool), in their declared standard deviations,
//           as unknowns beside each fit's pose. With the residuals f = J dx - C c of a fit, M the
//           projection that leaves out the pose's part: information += C' M C, pull -= C' M f. The
//           most likely errors under their declared distributions are (1 + information)^-1 pull.
//           Slow errors and what no calibration states (k_lens_residual_px, k_range_ripple_m) widen
//           the residuals' noise, the latter as often as neighbouring fits share them.
// Cost:     for each fit the normal equations, and k_calibration_errors^2 / 2 products a residual.
// Worst:    none is worse than another of as many markers.
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

// In this order: range offset, range scale, principal point x and y, focal length, then x, y and z
// of each of the tool's markers.
inline constexpr int k_common_errors = 5;
inline constexpr int k_calibration_errors = k_common_errors + 3 * k_markers_per_tool_max;
using ErrorVector = Eigen::Matrix<double, k_calibration_errors, 1>;
using ErrorMatrix = Eigen::Matrix<double, k_calibration_errors, k_calibration_errors>;

inline constexpr double k_lens_residual_px = 0.1, k_range_ripple_m = 0.001;  // 1 sigma

struct CalibrationErrors {
  ErrorMatrix information = ErrorMatrix::Zero();  // the lower half holds
  ErrorVector pull = ErrorVector::Zero();
  double ranges_m = 0;  // sum of the markers' mean ranges
  int fits = 0;
};

// The optimum of one fit, and how the common errors move it: about the tool's origin and the
// camera's axes, order (x, y, z, rx, ry, rz).
struct OptimalFit {
  Pose T_camera_tool;
  Matrix6 covariance = Matrix6::Zero();  // by noise, slow errors and what no calibration states
  Eigen::Matrix<double, 6, k_common_errors> by_errors =
      Eigen::Matrix<double, 6, k_common_errors>::Zero();  // in their stated sigmas
};

// rays: the lens around each marker; of_tool: which of the tool's markers each is, both in the
// markers' order; T_camera_tool: near the fit's optimum; errors: null to add nothing.
// Nothing is added by Reason::degenerate (the markers do not determine the pose) and bad_fit (a
// wrong labeling or minimum: no error explains what is left).
[[nodiscard]] Result<OptimalFit> add_fit(std::span<const WeightedMarker> markers,
                                         std::span<const LocalRays> rays,
                                         std::span<const int> of_tool, const Pose& T_camera_tool,
                                         const CameraUncertainty& camera, double marker_sigma_m,
                                         CalibrationErrors* errors) noexcept GLINT_NONBLOCKING;

}  // namespace glint
