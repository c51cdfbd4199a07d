// A tracked box on a slide. The depth images show the slide at k_slide_shown_m; with the slide at 0
// the model does not match them.
#pragma once

#include <string>
#include <vector>

#include "tests/unit/platform/runtime/session/followed_robot.hpp"

namespace glint {

inline constexpr double k_slide_shown_m = 0.1;

// Converts the box's model in this file to a robot with a slide.
inline RobotCloud on_a_slide(const std::string& path) {
  RobotCloud robot = read_robot_cloud(path);
  robot.links.push_back("carriage");
  robot.inputs = {"slide"};
  TreeJoint& slide = robot.tree.joints[0];
  slide.kind = JointKind::sliding;
  slide.axis = Vector3::UnitX();
  slide.input = 0;
  robot.tree.joint_count = robot.tree.input_count = 1;
  robot.point_links.assign(robot.points.size(), 1);
  for (Vector3f& point : robot.points) point.x() -= static_cast<float>(k_slide_shown_m);
  return robot;
}

// Replaces the model; its joint value is given as 0.
inline void follow_a_box_on_a_slide(const std::string& folder, Cell& cell) {
  follow_a_box(folder, 0, cell);
  write_robot_cloud(cell.mapping->model, on_a_slide(cell.mapping->model));
  cell.mapping->joints = {0};
}

}  // namespace glint
