// A recorded motion, placed into the simulated world.
#pragma once

#include "kernels/geometry.hpp"
#include "platform/sensors/trajectory.hpp"
#include "platform/sim/motion.hpp"

namespace glint::sim {

// The recording's deviations from its own middle (centre of its box, mean orientation), scaled, in
// the axes of that mean orientation; `anchor` is that middle's pose.
struct Placement {
  Pose anchor;
  double position_scale = 1;
  double rotation_scale = 1;
};

[[nodiscard]] MotionPointer placed_motion(Trajectory trajectory, const Placement& placement);

// The scale that makes the largest half side of the recording's box this long.
[[nodiscard]] double scale_to_half_extent(const Trajectory& trajectory, double half_extent_m);

}  // namespace glint::sim
