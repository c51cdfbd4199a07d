// What a tool's markers say near where the tool is expected, for a filter that expects it there.
//
// What:     the pose x with the least sum of chi-square and squared distance from the expectation,
//           both in sigmas; the step that the markers alone would take from x, and their own
//           information there. A filter with the same expectation that is given x moved by this
//           step, with the inverse of this information, ends at x: the expectation counts once.
//           Face-on, between the two minima of a flat tool, x is the pose that faces the camera.
// Cost:     one weighted fit of steps_max steps at most, a 6x6 factor.
// Worst:    a start that needs all its steps.
// Accuracy: first order about x. Markers nearly on a line, or a flat tool seen face-on, tell little
//           of a turn that only a cosine shows: their likelihood has two summits, each surer than
//           what lies between. A fit to the markers alone stands on one of them and states that
//           one's sureness; time after time the one on the expectation's side, so that a filter
//           walks there, sure of itself. About x they say as little as they know.
// Source:   the iterated extended Kalman filter: Bell and Cathey 1993, The iterated Kalman filter
//           update as a Gauss-Newton method, IEEE Transactions on Automatic Control 38(2).
#pragma once

#include <span>

#include "kernels/nonblocking.hpp"
#include "kernels/pose/expected_pose.hpp"
#include "kernels/pose/weighted_fit.hpp"

namespace glint {

// The reference straight on from x, however far the step turns. degenerate: the markers show
// nothing of a direction.
struct NearPose {
  Pose T_camera_tool;
  Matrix6 covariance = Matrix6::Zero();  // of the reference, as fit_covariance.hpp
  double chi_square = 0;                 // at x
  Reason reason = Reason::none;
};

// The markers' own near x. chi_square: of the markers and the expectation at x, of three numbers a
// marker. degenerate: the expectation's covariance is none, too.
struct AgreedPose : NearPose {
  int steps = 0;
};

// A flat tool turned about the markers' mean until it faces the camera. There, and only there, the
// linear equations hold for both of its minima: a tilt shows in the ranges alone.
[[nodiscard]] Pose face_on(std::span<const WeightedMarker> markers,
                           const Pose& T_camera_tool) noexcept GLINT_NONBLOCKING;

// Of one marker or more, from their linear equations about x.
[[nodiscard]] NearPose near_pose(std::span<const WeightedMarker> markers, const Pose& x,
                                 const Vector3& reference_m) noexcept GLINT_NONBLOCKING;

// Of one marker or more.
[[nodiscard]] AgreedPose agreed_pose(std::span<const WeightedMarker> markers,
                                     const ExpectedPose& expected,
                                     int steps_max) noexcept GLINT_NONBLOCKING;

}  // namespace glint
