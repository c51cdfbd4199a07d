// A tracked box on a slide. The depth images show the slide at k_slide_shown_m; with the slide at 0
// the model does not match them.
#pragma once

#include <string>
#include <vector>

#include "tests/unit/platform/runtime/session/followed_robot.hpp"

namespace glint {

inline constexpr double k_slide_shown_m = 0.1;

// Converts the box's model in this file to a robot with a slide.
inline RobotCloud with_slide_joint(const std::string& path) {
  RobotCloud robot = read_robot_cloud(path);
  robot.links.push_back("carriage");
  robot.inputs = {"slide"};
  TreeJoint& slide = robot.tree.joints[0];
  slide.kind = JointKind::prismatic;
  slide.axis = Vector3::UnitX();
  slide.input = 0;
  robot.tree.joint_count = robot.tree.input_count = 1;
  robot.point_links.assign(robot.points.size(), 1);
  for (Vector3f& point : robot.points) point.x() -= static_cast<float>(k_slide_shown_m);
  return robot;
}

// Replaces the model; its joint value is given as 0.
inline void configure_sliding_box(const std::string& folder, Cell& cell) {
  configure_box_robot(folder, 0, cell);
  write_robot_cloud(cell.mapping->model, with_slide_joint(cell.mapping->model));
  cell.mapping->joints = {0};
}

}  // namespace glint
