// What `glint reference` is given, and what of it is heard instead.
#pragma once

#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "platform/reference/find_reference.hpp"
#include "platform/reference/reference_listener.hpp"

namespace glint {

// Robot, joints and seed come from files and options, or are heard.
struct ReferenceArguments {
  RobotFiles robot;
  SceneFiles scene;
  std::vector<double> seed;
  std::string json, model, exported;
  int points = k_robot_cloud_points;
  bool visual = false;
  std::vector<double> range;  // --search-range
  double depth_bias_mm = 1e3 * SharedErrors{}.depth_sigma_m;
  double listen_s = 0;
  DdsSettings network;

  [[nodiscard]] bool has_robot() const { return !robot.urdf.empty() || !model.empty(); }
  [[nodiscard]] bool only_exports() const {
    return !exported.empty() && scene.depth.empty() && scene.joints.empty() &&
           scene.camera.empty() && seed.empty();
  }
};

// The range that is searched, and the declared errors.
[[nodiscard]] FindReferenceSettings settings_of(const ReferenceArguments& arguments);

using AnyRobot = std::variant<RobotModel, RobotCloud>;

// Throws InputError for an option that is missing.
void check_given(const ReferenceArguments& arguments);

// Hears what no file gives; null where nothing is missing or nobody listens.
[[nodiscard]] std::unique_ptr<ReferenceListener> listener_of(const ReferenceArguments& arguments);

[[nodiscard]] AnyRobot robot_of(ReferenceArguments& arguments, ReferenceListener* listener);

// Where the robot is guessed to be; joints that are heard stand in the scene from now on. Says what
// was heard.
[[nodiscard]] Pose start_of(ReferenceArguments& arguments, const AnyRobot& robot,
                            ReferenceListener* listener);

}  // namespace glint
