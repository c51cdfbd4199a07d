// How much a series of rotations moved each direction of the tool: what a calibration can see.
#pragma once

#include <span>

#include "kernels/motion/interpolate.hpp"

namespace glint {

// The root mean square by which the tool's direction was moved away from its mean, for the
// directions that were moved least (0) to most (2). A tool that only turns about one axis moves
// this axis not at all.
struct RotationSpread {
  Vector3 spread_rad = Vector3::Zero();      // rising
  Matrix3 directions = Matrix3::Identity();  // columns: unit, in the tool's frame
};

[[nodiscard]] RotationSpread rotation_spread(std::span<const StampedPose> poses);

}  // namespace glint
