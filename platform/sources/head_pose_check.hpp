// Validity check of a head pose from an external source.
#pragma once

#include <cmath>

#include "kernels/pose/head_pose.hpp"

namespace glint {

// Clears an invalid pose: not a rotation, not finite, or beyond 10 km, which indicates another
// unit. Normalises a rounded quaternion; keeps the bits of a recorded one.
inline void check_head_pose(HeadPose& head) {
  constexpr double k_position_max_m = 1e4;
  if (!head.valid) return;
  Quaternion& rotation = head.T_world_camera.rotation;
  const Vector3& position = head.T_world_camera.translation;
  const double square = rotation.squaredNorm();
  head.valid = std::abs(square - 1) < 1e-2 && position.cwiseAbs().maxCoeff() <= k_position_max_m &&
               position.allFinite();
  if (!head.valid) {
    head = HeadPose{};
  } else if (std::abs(square - 1) > 1e-12) {
    rotation.normalize();
  }
}

}  // namespace glint
