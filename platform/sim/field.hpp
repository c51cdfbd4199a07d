// A device, a tool, a headset and a robot as they are in the field: each differs from what its
// cell states.
//
// The errors are drawn from the distributions that the shipped settings state for an uncalibrated
// device (CameraUncertainty, Tool::marker_sigma_m, the robot's sigma), and by some that no setting
// states: the lens's residual, the range's period, the markers' radius, stamps, the headset's
// latency and drift. Same random seed, same device.
#pragma once

#include <cstdint>
#include <vector>

#include "platform/sim/scenario.hpp"

namespace glint::sim {

struct RobotPlacement {
  Pose T_world_robot;  // as stated
  double sigma_m = 0, sigma_rad = 0;
};

// What the user does.
enum class FieldTask {
  work,   // draws
  board,  // shows a chessboard: calibrate camera
  turn,   // turns the tool to all sides, near and far: calibrate depth and tool
  pivot,  // tilts it to all sides, its tip in a dent: calibrate pivot
  rest,   // lays it down: calibrate noise
  look    // and moves the head about it: calibrate headset
};

// Of work: a hand that rests and draws, clutter, a drop to 5 Hz for 4 s, a hidden tool for 1 s and
// one that is laid down for 3 s, at times that the random seed chooses. Of the others: the headset
// on a stand, the tool alone in view. duration_s: at least 5.
[[nodiscard]] Scenario field_run(const Camera& camera, const std::vector<Tool>& tools,
                                 const RobotPlacement& robot, double duration_s, std::uint64_t seed,
                                 FieldTask task = FieldTask::work);

}  // namespace glint::sim
