// Predicted pose of a tool, and the squared Mahalanobis distance of a fitted pose from it, to
// choose among ambiguous pose hypotheses.
//
// What:     the squared distance of a fitted pose from a predicted one, normalised by the sum of
//           both covariances.
// Cost:     one 6x6 factor and solution, two lever arms: 0.4 us.
// Worst:    data independent.
// Accuracy: rounding, for errors of up to a radian; beyond, the value only has to be large.
// Source:   Mahalanobis 1936; as a gate: Bar-Shalom, Li and Kirubarajan 2001, Estimation with
//           Applications to Tracking and Navigation, section 2.3.2.
#pragma once

#include "kernels/geometry.hpp"
#include "kernels/nonblocking.hpp"

namespace glint {

// Odds of a pose against the likeliest other one: twice the logarithm of their likelihood ratio, in
// units of chi-square. Below k_odds_min a pose is ambiguous: the other one is true once in 3000.
// Odds are limited to k_odds_max, so that few frames suffice to reject a wrong pose.
inline constexpr double k_odds_min = 16;
inline constexpr double k_odds_max = 40;

// covariance: of (reference position, rotation about the camera frame's fixed axes) in metres and
// radians; as in fit_covariance.hpp.
struct PredictedPose {
  Pose T_camera_tool;
  Matrix6 covariance = Matrix6::Zero();
  Vector3 reference_m = Vector3::Zero();  // tool frame: the point whose position is predicted
  // Chi-square by which earlier frames preferred this pose to the likeliest other one. Hypotheses
  // of this frame that differ by more outweigh it.
  double odds = k_odds_max;
};

// Value if the distance cannot be computed. A consistent pose has 6 on average.
inline constexpr double k_mahalanobis_unknown = 1e300;

// Returns the squared Mahalanobis distance. found_covariance: as above, about found_reference_m of
// the tool's frame.
[[nodiscard]] double mahalanobis_square(
    const PredictedPose& expected, const Pose& found, const Matrix6& found_covariance,
    const Vector3& found_reference_m) noexcept GLINT_NONBLOCKING;

}  // namespace glint
