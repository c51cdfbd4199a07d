// Pose of a robot's base from touches: the pen's tip rests on points whose coordinates in the
// base's frame are known.
//
// Least squares of w_i = R k_i + t for known points k_i and measured tips w_i, each weighted by the
// inverse of its touch's own covariance. Errors that all touches share (systematic ones of the
// tracker) shift every tip alike: they do not enter the weights but the result's covariance.
// Start: fit_rigid (kernels/pose/rigid_fit.hpp). Then Gauss-Newton.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "kernels/geometry.hpp"

namespace glint {

struct TouchedPoint {
  std::string name;
  Vector3 known_m = Vector3::Zero();     // in the base's frame
  Vector3 tip_m = Vector3::Zero();       // measured, in the frame of the result
  Matrix3 own_m2 = Matrix3::Identity();  // covariance of this touch alone; positive definite
  Matrix3 shared_m2 = Matrix3::Zero();   // covariance of the error that all touches share
};

inline constexpr std::size_t k_known_points_min = 3;
inline constexpr std::size_t k_known_points_max = 1000;

struct TouchedBase {
  Pose T_frame_base;
  // Of translation (m) and rotation (rad) about the frame's axes, the rotation about the base's
  // origin.
  Matrix6 covariance = Matrix6::Zero();
  std::vector<double> distances_m;  // of each tip from its known point
  double chi_square = 0;            // weighted squares of the residuals; 3 n - 6 degrees of freedom
  double chi_square_max = 0;        // exceeded by one valid set in 1000
  std::string reason;               // of a refusal; empty: accepted
};

// Throws InputError, naming `what`, for fewer than k_known_points_min or more than
// k_known_points_max points, numbers that are not finite, and points that coincide or lie on a
// line.
[[nodiscard]] TouchedBase touched_base(std::span<const TouchedPoint> points,
                                       const std::string& what);

}  // namespace glint
