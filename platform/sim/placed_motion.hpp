// Places a recorded motion in the simulated world.
#pragma once

#include "kernels/geometry.hpp"
#include "platform/formats/trajectory.hpp"
#include "platform/sim/motion.hpp"

namespace glint::sim {

// Deviations from the recording's centre (centre of its box, mean orientation), scaled, in the axes
// of the mean orientation. `anchor` is the pose of the centre.
struct Placement {
  Pose anchor;
  double position_scale = 1;
  double rotation_scale = 1;
};

[[nodiscard]] MotionPointer placed_motion(Trajectory trajectory, const Placement& placement);

// Returns the scale that makes the largest half side of the recording's box equal to half_extent_m.
[[nodiscard]] double scale_to_half_extent(const Trajectory& trajectory, double half_extent_m);

}  // namespace glint::sim
