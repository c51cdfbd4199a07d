// Field scenario: ground truth of device, tool, headset and robot that differs from the cell's
// values.
//
// The errors are drawn from the distributions that the shipped settings state for an uncalibrated
// device (CameraUncertainty, Tool::marker_sigma_m, the robot's sigma). Further errors have no
// setting: the lens's residual, the range's period, the markers' radius, stamps, the headset's
// latency and drift. The same random seed gives the same device.
#pragma once

#include <cstdint>
#include <vector>

#include "platform/sim/scenario.hpp"

namespace glint::sim {

struct RobotPlacement {
  Pose T_world_robot;  // as stated
  double sigma_m = 0, sigma_rad = 0;
};

// Activity of the user.
enum class FieldTask {
  work,      // draws
  target,    // shows a chessboard: calibrate camera
  rotate,    // rotates the tool in all directions, near and far: calibrate depth and tool
  pivot,     // tilts it in all directions with the tip in a dent: calibrate pivot
  still,     // keeps it static: calibrate noise
  move_head  // and moves the head around it: calibrate headset
};

// work: a hand alternates between rest and strokes; clutter; at times given by the random seed: a
// drop to 5 Hz for 4 s, a hidden tool for 1 s, a static tool for 3 s. Other tasks: the headset on a
// stand, only the tool in view. Requires duration_s >= 5.
[[nodiscard]] Scenario field_run(const Camera& camera, const std::vector<Tool>& tools,
                                 const RobotPlacement& robot, double duration_s, std::uint64_t seed,
                                 FieldTask task = FieldTask::work);

}  // namespace glint::sim
