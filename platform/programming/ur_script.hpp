// A path as a plain URScript program: movel to waypoints and to where strokes begin, movep along
// strokes. Whether the robot reaches it, and what it meets on the way, is not checked.
//
// Poses are p[x, y, z, rx, ry, rz] in metres and radians, a rotation vector, in the frame that the
// path is in: the controller's base. (ROS's base_link of these robots is turned by 180 degrees
// about z from it.)
#pragma once

#include <string>

#include "platform/programming/path.hpp"

namespace glint {

struct UrScriptSettings {
  double travel_m_s = 0.25;  // movel
  double stroke_m_s = 0.05;  // movep
  double acceleration_m_s2 = 0.5;
  double blend_m = 0.005;  // at most; never more than half the way to either neighbour
  std::string name = "glint_path";
};

// Blends that touch are refused by the controller: each ends by the middle of the way to either
// neighbour, and is 0 where the robot stops: at the program's end and at both ends of a stroke.
// Throws InputError for a setting that is not above 0 (blend: 0 or more), or a name that is no
// word.
[[nodiscard]] std::string ur_script(const DrawnPath& path, const UrScriptSettings& settings);

}  // namespace glint
