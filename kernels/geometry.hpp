// Vectors, rotations and rigid transforms. T_a_b maps coordinates in b to coordinates in a.
// Camera frame: x right, y down, z forward (REP-103 optical). Pixel centres are at integer + 0.5.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace glint {

using Vector2 = Eigen::Vector2d;
using Vector3 = Eigen::Vector3d;
using Matrix3 = Eigen::Matrix3d;
using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Quaternion = Eigen::Quaterniond;

struct Pose {
  Quaternion rotation = Quaternion::Identity();
  Vector3 translation = Vector3::Zero();

  // Maps a point's coordinates.
  [[nodiscard]] Vector3 operator*(const Vector3& point) const {
    return rotation * point + translation;
  }
  // T_a_c = T_a_b * T_b_c
  [[nodiscard]] Pose operator*(const Pose& other) const {
    return {(rotation * other.rotation).normalized(), rotation * other.translation + translation};
  }
  [[nodiscard]] Pose inverse() const {
    const Quaternion back = rotation.conjugate();
    return {back, -(back * translation)};
  }
};

// Skew-symmetric matrix [v]x of the cross product: [v]x w = v x w.
[[nodiscard]] inline Matrix3 cross_matrix(const Vector3& v) {
  Matrix3 m;
  m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return m;
}

// Smallest rotation that maps the direction `from` to `to`; for opposite directions, about any
// perpendicular axis. Replaces Eigen's FromTwoVectors, whose decomposition is slow to compile.
[[nodiscard]] inline Quaternion rotation_between(const Vector3& from, const Vector3& to) {
  const Vector3 a = from.normalized(), b = to.normalized();
  const double w = 1 + a.dot(b);
  const Vector3 across = a.unitOrthogonal();
  if (w < 1e-12) return {0, across.x(), across.y(), across.z()};
  const Vector3 axis = a.cross(b);
  return Quaternion(w, axis.x(), axis.y(), axis.z()).normalized();
}

}  // namespace glint
