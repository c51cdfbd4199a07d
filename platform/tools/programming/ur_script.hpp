// Post-processor for Universal Robots (URScript): movel to waypoints and to the start of strokes,
// movep along strokes.
//
// Poses are p[x, y, z, rx, ry, rz] in metres and radians (rotation vector), in the path's frame:
// the controller's base. ROS's base_link of these robots is rotated by 180 degrees about z from it.
// Source: Universal Robots, The URScript Programming Language.
#pragma once

#include <string>

#include "platform/tools/programming/robot_program.hpp"

namespace glint {

// The program selects no frames: URScript numbers none. With T_robot_user the moves are pose_trans
// of pen_frame. Throws InputError for a reserved name.
[[nodiscard]] std::string ur_script(const RobotProgram& program);

}  // namespace glint
