// Interpolation of a recorded motion at any time, with its time derivative: Catmull-Rom spline for
// position, normalised linear interpolation for rotation.
//
// What:     interpolates between the middle two of four samples. Position: cubic with their finite
//           differences as slopes. Rotation: normalised linear blend of the two quaternions.
// Cost:     no loop, one square root.
// Worst:    opposite rotations of the middle two samples; these do not occur in a hand's motion.
// Accuracy: position to the third order of the gap; rotation within angle^3 / 100 of SLERP: 1e-5
//           deg for neighbours one degree apart.
// Source:   Catmull and Rom 1974, "A class of local interpolating splines", for non-uniform time
//           stamps.
#pragma once

#include <cmath>

#include "kernels/calibrate/scalar.hpp"

namespace glint {

// Four consecutive samples with increasing time stamps.
struct MotionSegment {
  double seconds[4] = {};
  Vector3 position_m[4];
  Quaternion rotation[2];  // of the middle two, in one hemisphere
};

template <class Scalar>
struct PoseOf {
  QuaternionOf<Scalar> rotation;
  Vector3Of<Scalar> translation;
};

// Extrapolates slightly beyond the middle two samples: the derivative by a time offset remains
// valid there.
template <class Scalar>
[[nodiscard]] PoseOf<Scalar> interpolated_pose(const MotionSegment& piece,
                                               const Scalar& seconds) noexcept {
  using std::sqrt;
  const double gap = piece.seconds[2] - piece.seconds[1];
  const Scalar u = (seconds - Scalar(piece.seconds[1])) / Scalar(gap);
  const auto slope = [&](int i) -> Vector3 {  // at sample i, per gap
    const double before = piece.seconds[i] - piece.seconds[i - 1];
    const double after = piece.seconds[i + 1] - piece.seconds[i];
    const Vector3 left = (piece.position_m[i] - piece.position_m[i - 1]) / before;
    const Vector3 right = (piece.position_m[i + 1] - piece.position_m[i]) / after;
    return gap * (left * after + right * before) / (before + after);
  };
  const Vector3 from = slope(1), to = slope(2), step = piece.position_m[2] - piece.position_m[1];
  const Vector3 square = 3.0 * step - 2.0 * from - to, cube = from + to - 2.0 * step;

  PoseOf<Scalar> pose;
  pose.translation = piece.position_m[1].cast<Scalar>() + from.cast<Scalar>() * u +
                     square.cast<Scalar>() * (u * u) + cube.cast<Scalar>() * (u * u * u);
  const Eigen::Matrix<Scalar, 4, 1> blend =
      piece.rotation[0].coeffs().template cast<Scalar>() * (Scalar(1) - u) +
      piece.rotation[1].coeffs().template cast<Scalar>() * u;
  pose.rotation.coeffs() = blend / sqrt(blend.dot(blend));
  return pose;
}

}  // namespace glint
