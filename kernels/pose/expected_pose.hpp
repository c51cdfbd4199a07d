// Where a tool is expected, to choose among readings of its markers that all might be true.
//
// What:     the squared distance of a fitted pose from an expected one, in sigmas of both together.
// Cost:     one 6x6 factor and solution, two lever arms: 0.4 us.
// Worst:    none is worse than another.
// Accuracy: rounding, for errors of a radian or less; beyond, it only has to be large.
// Source:   Mahalanobis 1936; as a gate: Bar-Shalom, Li and Kirubarajan 2001, Estimation with
//           Applications to Tracking and Navigation, section 2.3.2.
#pragma once

#include "kernels/geometry.hpp"
#include "kernels/nonblocking.hpp"

namespace glint {

// Odds of a pose against the likeliest other one: twice the logarithm of their likelihoods' ratio,
// in units of chi-square. Below the least a pose is ambiguous: the other one is true once in 3000.
// More than the most does not count, so that a wrong pose needs few frames to be refuted.
inline constexpr double k_odds_least = 16;
inline constexpr double k_odds_most = 40;

// covariance: of (the reference's place, rotation about the camera frame's fixed axes) in metres
// and radians; as in fit_covariance.hpp.
struct ExpectedPose {
  Pose T_camera_tool;
  Matrix6 covariance = Matrix6::Zero();
  Vector3 reference_m = Vector3::Zero();  // tool frame: the point whose place is expected
  // By how much of chi-square the frames before preferred it to the likeliest other pose. Readings
  // of this frame that differ by more outweigh it.
  double odds = k_odds_most;
};

// A pose that agrees has 6 on average. Where it cannot be told, as large as this:
inline constexpr double k_no_surprise_known = 1e300;

// found_covariance: as above, about found_reference_m of the tool's frame.
[[nodiscard]] double surprise_of(const ExpectedPose& expected, const Pose& found,
                                 const Matrix6& found_covariance,
                                 const Vector3& found_reference_m) noexcept GLINT_NONBLOCKING;

}  // namespace glint
