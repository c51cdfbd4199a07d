// Lever arm Jacobians of a rigid body: move a pose covariance between reference points and frames.
#pragma once

#include <algorithm>
#include <cmath>

#include "kernels/geometry.hpp"
#include "kernels/nonblocking.hpp"

namespace glint {

// Jacobian of a point by a translation and a small rotation dtheta about the frame's fixed axes: p
// -> p + translation + dtheta x lever, with the lever from the pose's reference to the point.
[[nodiscard]] inline Eigen::Matrix<double, 3, 6> point_by_pose(const Vector3& lever) {
  Eigen::Matrix<double, 3, 6> j;
  j << 1, 0, 0, 0, lever.z(), -lever.y(),  //
      0, 1, 0, -lever.z(), 0, lever.x(),   //
      0, 0, 1, lever.y(), -lever.x(), 0;
  return j;
}

// Jacobian of (reference, rotation) when the reference moves by `lever`.
[[nodiscard]] inline Matrix6 pose_by_pose(const Vector3& lever) {
  Matrix6 j = Matrix6::Identity();
  j.topRows<3>() = point_by_pose(lever);
  return j;
}

// A pose's covariance with its reference moved by `offset`: J C J' with J = pose_by_pose(offset).
[[nodiscard]] Matrix6 moved_covariance(const Matrix6& covariance,
                                       const Vector3& offset) noexcept GLINT_NONBLOCKING;

// A pose's covariance about the axes of the frame that `rotation` maps to.
[[nodiscard]] Matrix6 rotated_covariance(const Matrix6& covariance,
                                         const Quaternion& rotation) noexcept GLINT_NONBLOCKING;

// Upper bound on the variance in any direction: no eigenvalue exceeds the largest row sum
// (Gershgorin 1931).
[[nodiscard]] inline double largest_variance(const Matrix3& covariance) {
  double most = 0;
  for (int i = 0; i < 3; ++i) {
    const double row =
        std::abs(covariance(i, 0)) + std::abs(covariance(i, 1)) + std::abs(covariance(i, 2));
    most = std::max(most, row);
  }
  return most;
}

}  // namespace glint
