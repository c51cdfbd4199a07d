// Covariance of a pose caused by systematic errors (consider parameters): calibration errors and
// correlated errors.
//
// What:     parameters c that the fit does not estimate ("consider" parameters), each with a
//           standard deviation s_c: cov = N^-1 (sum h_c h_c' s_c^2) N^-1, N = sum J' J of the
//           weighted fit (normal_equations.hpp), h_c = sum J' df/dc. Common to all markers: range
//           offset, range scale, principal point, focal length. Of each marker: its position in the
//           tool, correlated errors of its range and of its centroid.
// Cost:     the normal equations once more, their inverse, four products of 6x6 matrices, and 12
//           products of 6-vectors per marker.
// Worst:    data independent for a given number of markers.
// Accuracy: first order in the errors.
// Source:   Schmidt 1966, Application of state-space methods to navigation problems; Bierman 1977,
//           Factorization Methods for Discrete Sequential Estimation, chapter VIII.
#pragma once

#include <span>

#include "kernels/geometry.hpp"
#include "kernels/motion/correlated_errors.hpp"
#include "kernels/nonblocking.hpp"
#include "kernels/pose/local_rays.hpp"
#include "kernels/pose/weighted_marker.hpp"
#include "kernels/result.hpp"

namespace glint {

// Standard deviations of a camera's calibration and of its correlated errors. The defaults hold for
// an uncalibrated device that uses the lens model of another unit.
struct CameraUncertainty {
  double range_offset_m = 0.006;
  double range_scale = 0.01;      // a HoloLens 2 measured 20 mm steps as 20.3 to 20.5 mm
  double principal_point_px = 3;  // per axis; two HoloLens 2 differ by 5.5 px
  double focal_scale = 0.003;
  // Of each marker, correlated in time. From two static tools in front of a HoloLens 2, 120 s, as
  // of four markers.
  double correlated_range_m = 0.0007;
  double correlated_centroid_px = 0.05;  // per axis
  double fast_share = 0.6;               // of these two variances: the part correlated for
                                         // CorrelationTimes::fast_s
  double time_stamp_s = 0.002;           // of mid-exposure's time stamp: counts if the tool moves
};
inline constexpr CameraUncertainty k_exact_camera{0, 0, 0, 0, 0, 0, 0, 0};

// Covariances of the reference point's pose, order (x, y, z, rx, ry, rz), about the camera's axes.
struct SystematicCovariance {
  Matrix6 calibration = Matrix6::Zero();  // constant
  CorrelatedErrors correlated;
};

// rays: the lens linearised at each marker, in the markers' order; marker_sigma_m: of a marker's
// position in the tool, per axis; reference_m: tool frame. Returns Reason::degenerate if the
// markers do not determine the pose.
[[nodiscard]] Result<SystematicCovariance> systematic_covariance(
    std::span<const WeightedMarker> markers, std::span<const LocalRays> rays,
    const Pose& T_camera_tool, const Vector3& reference_m, const CameraUncertainty& camera,
    double marker_sigma_m) noexcept GLINT_NONBLOCKING;

}  // namespace glint
