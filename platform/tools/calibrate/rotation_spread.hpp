// Spread of a series of rotations per tool direction: the observability of a calibration.
#pragma once

#include <span>

#include "kernels/motion/interpolate.hpp"

namespace glint {

// Root mean square deviation of a tool direction from its mean, for the directions of least (0) to
// most (2) motion. A rotation about one axis leaves that axis with 0.
struct RotationSpread {
  Vector3 spread_rad = Vector3::Zero();      // ascending
  Matrix3 directions = Matrix3::Identity();  // columns: unit, tool frame
};

[[nodiscard]] RotationSpread rotation_spread(std::span<const TimedPose> poses);

}  // namespace glint
