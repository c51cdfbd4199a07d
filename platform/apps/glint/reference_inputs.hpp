// Inputs of `glint reference`, from files and options or received over DDS.
#pragma once

#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "platform/tools/reference/find_reference.hpp"
#include "platform/tools/reference/reference_listener.hpp"

namespace glint {

struct TouchArguments {
  std::string points, tips, button, tool;
  double sigma_mm = 1;
};

// Robot, joints and initial pose come from files and options, or are received over DDS.
struct ReferenceArguments {
  RobotFiles robot;
  SceneFiles scene;
  std::vector<double> initial_guess;
  std::string json, model, export_file;
  int points = k_robot_cloud_points;
  bool visual = false;
  std::vector<double> range;  // --search-range
  double depth_bias_mm = 1e3 * SystematicErrors{}.depth_sigma_m;
  double listen_s = 0;
  DdsSettings network;
  TouchArguments touch;  // --touch: the points that replace images and initial pose

  [[nodiscard]] bool has_robot() const { return !robot.urdf.empty() || !model.empty(); }
  [[nodiscard]] bool only_exports() const {
    return !export_file.empty() && scene.depth.empty() && scene.joints.empty() &&
           scene.camera.empty() && initial_guess.empty();
  }
};

// Returns the search range and the declared errors.
[[nodiscard]] FindReferenceSettings settings_of(const ReferenceArguments& arguments);

using AnyRobot = std::variant<RobotModel, RobotCloud>;

// Throws InputError for a missing option.
void require_inputs(const ReferenceArguments& arguments);

// Returns a listener for the inputs that no file provides; null if none is missing or without
// --listen.
[[nodiscard]] std::unique_ptr<ReferenceListener> listener_of(const ReferenceArguments& arguments);

[[nodiscard]] AnyRobot robot_of(ReferenceArguments& arguments, ReferenceListener* listener);

// Returns the initial pose of the robot and stores received joint positions in the scene. Prints
// what was received.
[[nodiscard]] Pose initial_pose_of(ReferenceArguments& arguments, const AnyRobot& robot,
                                   ReferenceListener* listener);

}  // namespace glint
