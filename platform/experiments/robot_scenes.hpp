// Scenes with a robot in them: real ones with their files' names, and simulated ones with the
// truth.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "platform/reference/scene.hpp"

namespace glint {

// Five depth frames of an xArm7 before a camera that stands still, joint positions, masks, and the
// pose that its authors published, which is an estimate.
struct RobotScan {
  RobotModel robot;
  std::vector<SceneFrame> frames, masked;
  Pose published;  // T_camera_base
};
// folder: holds robot_scans/xarm7_realsense and robots/xarm7. Throws InputError.
[[nodiscard]] RobotScan read_robot_scan(const std::string& folder);

// The scan's frames without the robot: where it was, what the others see behind it, or nothing.
[[nodiscard]] std::vector<SceneFrame> without_robot(const RobotScan& scan);

struct SimulatedScene {
  std::vector<SceneFrame> frames;  // the world is the first camera
  Pose T_world_base;               // the truth
  std::vector<double> positions;   // of the joints
};
struct SimulationSettings {
  int views = 1;
  bool mask = true;
  bool half_hidden = true;
  double distance_m = 1.2;
  double noise = 0.01;            // of the depth, independent from pixel to pixel
  double depth_bias_m = 0;        // a constant, and slopes along both sides of the picture ..
  double depth_slope_m = 0;       // .. at its edges, each within these, shared by all views
  std::vector<double> positions;  // of the joints; empty: random
};
// Robot on a floor before a wall; the instance chooses all that is
// random.
[[nodiscard]] SimulatedScene simulate_scene(const RobotModel& robot,
                                            const SimulationSettings& settings, std::uint64_t seed,
                                            std::uint64_t instance);

// Each coordinate within +-shift_m and, about fixed axes, +-degrees of the true one.
[[nodiscard]] Pose start_about(const Pose& truth, double shift_m, double degrees,
                               std::uint64_t seed, std::uint64_t number);

}  // namespace glint
