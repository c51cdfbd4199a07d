// Path drawn with the pen, in the robot's frame: a sequence of waypoints and strokes.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "kernels/motion/motion_state.hpp"

namespace glint {

enum class PathKind : std::uint8_t { waypoint, stroke };

struct PathElement {
  PathKind kind = PathKind::waypoint;
  std::vector<UncertainPose> points;  // T_robot_tip; waypoint: one, stroke: two or more
  std::string name{};                 // unique in a path; edits and files use it
};

using DrawnPath = std::vector<PathElement>;

[[nodiscard]] inline std::size_t point_count(const DrawnPath& path) {
  std::size_t count = 0;
  for (const PathElement& element : path) count += element.points.size();
  return count;
}

[[nodiscard]] inline const char* name_of(PathKind kind) {
  return kind == PathKind::waypoint ? "waypoint" : "stroke";
}

}  // namespace glint
