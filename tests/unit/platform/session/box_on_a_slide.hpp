// The box that a session follows, on a slide: where its pictures show it the slide stands at
// k_slide_shown_m, and at 0 its model is not to be found in them.
#pragma once

#include <string>
#include <vector>

#include "tests/unit/platform/session/followed_robot.hpp"

namespace glint {

inline constexpr double k_slide_shown_m = 0.1;

// Of the box's model in this file.
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

// The model in its place, its joint given at 0.
inline void follow_a_box_on_a_slide(const std::string& folder, Cell& cell) {
  follow_a_box(folder, 0, cell);
  write_robot_cloud(cell.mapping->model, on_a_slide(cell.mapping->model));
  cell.mapping->joints = {0};
}

}  // namespace glint
