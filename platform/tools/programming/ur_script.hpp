// Writes a path as a URScript program: movel to waypoints and to the start of strokes, movep along
// strokes. Reachability and collisions are not checked.
//
// Poses are p[x, y, z, rx, ry, rz] in metres and radians (rotation vector), in the path's frame:
// the controller's base. ROS's base_link of these robots is rotated by 180 degrees about z from it.
#pragma once

#include <string>

#include "platform/tools/programming/path.hpp"

namespace glint {

struct UrScriptSettings {
  double travel_m_s = 0.25;  // movel
  double stroke_m_s = 0.05;  // movep
  double acceleration_m_s2 = 0.5;
  double blend_m = 0.005;  // maximum; also at most half of the distance to either neighbour
  std::string name = "glint_path";
};

// The controller refuses overlapping blends: each ends at half of the distance to either neighbour.
// It is 0 where the robot stops: at the program's end and at both ends of a stroke.
// Throws InputError for a setting that is not above 0 (blend: 0 or more), or a name that is no
// identifier.
[[nodiscard]] std::string ur_script(const DrawnPath& path, const UrScriptSettings& settings);

}  // namespace glint
