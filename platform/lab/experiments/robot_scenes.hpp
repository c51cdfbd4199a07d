// Depth scenes of a robot: real ones from files, and simulated ones with ground truth.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "platform/tools/reference/scene.hpp"

namespace glint {

// Five depth frames of an xArm7 from a static camera, joint positions, masks, and the pose that its
// authors published, which is an estimate.
struct RobotScan {
  RobotModel robot;
  std::vector<SceneFrame> frames, masked;
  Pose published;  // T_camera_base
};
// folder: contains robot_scans/xarm7_realsense and robots/xarm7. Throws InputError.
[[nodiscard]] RobotScan read_robot_scan(const std::string& folder);

// Returns the scan's frames without the robot: its pixels get the depth behind it from the other
// frames, or none.
[[nodiscard]] std::vector<SceneFrame> without_robot(const RobotScan& scan);

struct SimulatedScene {
  std::vector<SceneFrame> frames;  // the world is the first camera's frame
  Pose T_world_base;               // ground truth
  std::vector<double> positions;   // of the joints
};
struct SimulationSettings {
  int views = 1;
  bool mask = true;
  bool half_hidden = true;
  double distance_m = 1.2;
  double noise = 0.01;            // relative depth noise, independent from pixel to pixel
  double depth_bias_m = 0;        // limit of a random constant offset, shared by all views
  double depth_slope_m = 0;       // limit of random slopes, at the image edges; shared by all views
  std::vector<double> positions;  // of the joints; empty: random
};
// Robot on a floor in front of a wall. `instance` selects all random values.
[[nodiscard]] SimulatedScene simulate_scene(const RobotModel& robot,
                                            const SimulationSettings& settings, std::uint64_t seed,
                                            std::uint64_t instance);

// Returns an initial pose: each coordinate within +-shift_m and, about fixed axes, +-degrees of the
// true one.
[[nodiscard]] Pose initial_pose_near(const Pose& truth, double shift_m, double degrees,
                                     std::uint64_t seed, std::uint64_t number);

}  // namespace glint
