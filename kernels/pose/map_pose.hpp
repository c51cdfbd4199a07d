// MAP pose of a tool from its markers and the motion filter's prediction, with the markers' own
// information there (relinearised measurement, IEKF).
//
// What:     the pose x that minimises chi-square plus the squared Mahalanobis distance from the
//           prediction; the Gauss-Newton step of the markers alone from x; their information matrix
//           at x. A filter with the same prediction takes x moved by this step as its measurement,
//           with the inverse of this information as covariance. Its update then ends at x, so the
//           prediction counts once. For a flat tool seen face-on, face_on_pose() gives x, midway
//           between the two minima.
// Cost:     one weighted fit of at most steps_max steps, a 6x6 factor.
// Worst:    an initial guess that needs all its steps.
// Accuracy: first order about x. Markers nearly on a line, or a flat tool seen face-on, determine a
//           rotation only through its cosine. Their likelihood then has two maxima, each with a
//           smaller covariance than the poses between them. A fit to the markers alone converges to
//           one maximum and returns the covariance of that one. Frame after frame this is the
//           maximum on the prediction's side, so the filter drifts there and becomes overconfident.
//           The information at x is consistent.
// Source:   the iterated extended Kalman filter: Bell and Cathey 1993, The iterated Kalman filter
//           update as a Gauss-Newton method, IEEE Transactions on Automatic Control 38(2).
#pragma once

#include <span>

#include "kernels/nonblocking.hpp"
#include "kernels/pose/expected_pose.hpp"
#include "kernels/pose/weighted_fit.hpp"

namespace glint {

// x moved by the markers' Gauss-Newton step. The reference point moves along a straight line,
// whatever the step's rotation. Reason::degenerate if the markers do not determine a direction.
struct LinearisedPose {
  Pose T_camera_tool;
  Matrix6 covariance = Matrix6::Zero();  // of (reference, rotation), as in fit_covariance.hpp
  double chi_square = 0;                 // at x
  Reason reason = Reason::none;
};

// linearised_pose() at the MAP pose x. chi_square: of the markers and the prediction at x, with
// three degrees of freedom per marker. Reason::degenerate also if the prediction's covariance is
// not positive definite.
struct MapPose : LinearisedPose {
  int steps = 0;
};

// Rotates a flat tool about the markers' mean until it faces the camera, midway between the pose
// and its depth flip. Only there do the linear equations hold for both minima: a tilt shows in the
// ranges alone.
[[nodiscard]] Pose face_on_pose(std::span<const WeightedMarker> markers,
                                const Pose& T_camera_tool) noexcept GLINT_NONBLOCKING;

// Gauss-Newton step of the markers alone, linearised at x. Requires at least one marker.
// reference_m: tool frame.
[[nodiscard]] LinearisedPose linearised_pose(std::span<const WeightedMarker> markers, const Pose& x,
                                             const Vector3& reference_m) noexcept GLINT_NONBLOCKING;

// Requires at least one marker.
[[nodiscard]] MapPose map_pose(std::span<const WeightedMarker> markers,
                               const PredictedPose& expected,
                               int steps_max) noexcept GLINT_NONBLOCKING;

}  // namespace glint
