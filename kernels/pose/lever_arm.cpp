#include "kernels/pose/lever_arm.hpp"

namespace glint {

// Without the products by ones and zeros.
Matrix6 moved_covariance(const Matrix6& covariance, const Vector3& offset) noexcept {
  const Matrix3 turned = point_by_pose(offset).rightCols<3>();
  const Matrix3 position_rotation =
      covariance.topRightCorner<3, 3>() + turned * covariance.bottomRightCorner<3, 3>();
  Matrix6 moved = covariance;
  moved.topLeftCorner<3, 3>() +=
      turned * covariance.bottomLeftCorner<3, 3>() + position_rotation * turned.transpose();
  moved.topRightCorner<3, 3>() = position_rotation;
  moved.bottomLeftCorner<3, 3>() = position_rotation.transpose();
  return moved;
}

Matrix6 rotated_covariance(const Matrix6& covariance, const Quaternion& rotation) noexcept {
  Matrix6 turn = Matrix6::Zero();
  turn.topLeftCorner<3, 3>() = rotation.toRotationMatrix();
  turn.bottomRightCorner<3, 3>() = turn.topLeftCorner<3, 3>();
  return turn * covariance * turn.transpose();
}

}  // namespace glint
