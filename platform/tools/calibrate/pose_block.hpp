// A pose as a Ceres parameter block: quaternion x, y, z, w, then the translation.
#pragma once

#include <ceres/manifold.h>

#include <array>

#include "kernels/geometry.hpp"

namespace glint {

using PoseBlock = std::array<double, 7>;
using PoseManifold =
    ceres::ProductManifold<ceres::EigenQuaternionManifold, ceres::EuclideanManifold<3>>;

[[nodiscard]] inline PoseBlock block_of(const Pose& pose) {
  const auto& q = pose.rotation.coeffs();
  const Vector3& t = pose.translation;
  return {q[0], q[1], q[2], q[3], t[0], t[1], t[2]};
}

[[nodiscard]] inline Pose pose_of(const PoseBlock& block) {
  return {Quaternion(block.data()).normalized(), Vector3(block[4], block[5], block[6])};
}

}  // namespace glint
