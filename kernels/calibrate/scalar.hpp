// Vectors and rotations for any scalar type, so that one template computes a residual and its
// derivatives.
#pragma once

#include "kernels/geometry.hpp"

namespace glint {

template <class Scalar>
using Vector2Of = Eigen::Matrix<Scalar, 2, 1>;
template <class Scalar>
using Vector3Of = Eigen::Matrix<Scalar, 3, 1>;
template <class Scalar>
using QuaternionOf = Eigen::Quaternion<Scalar>;

// q v q*, for a unit q, by two cross products: v + 2 w (u x v) + 2 u x (u x v).
template <class Scalar>
[[nodiscard]] Vector3Of<Scalar> rotated(const QuaternionOf<Scalar>& q,
                                        const Vector3Of<Scalar>& v) noexcept {
  const Vector3Of<Scalar> u = q.vec();
  const Vector3Of<Scalar> twice = Scalar(2) * u.cross(v);
  return v + q.w() * twice + u.cross(twice);
}

}  // namespace glint
