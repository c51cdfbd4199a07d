// Post-processor for FANUC (LS, the text form of a teach pendant program).
//
// X, Y, Z in millimetres; W, P, R in degrees about the fixed axes x, y, z. Blends are corner
// regions in whole millimetres (CRn), rounded down but at least 1: the controller ends them at half
// of the distance to a neighbour. LS has no absolute acceleration: the controller's own applies.
// Speeds are rounded down to whole mm/s. The configuration is unknown and written as 'N U T, 0, 0,
// 0'. Source: FANUC Robotics, SYSTEM R-30iA and R-30iB HandlingTool Setup and Operations Manual.
#pragma once

#include <string>

#include "platform/tools/programming/robot_program.hpp"

namespace glint {

inline constexpr std::size_t k_fanuc_positions_max = 1500;  // of one program

// The name is written in upper case; the controller expects the file NAME.ls.
// Throws InputError for more positions than k_fanuc_positions_max, a name longer than 36 characters
// or reserved, a user frame above 9, or of 0 with T_robot_user (which is not defined in LS: the
// remarks state the pose of UFRAME n), a tool frame outside of 1 to 10, a speed outside of 1 to
// 2000 mm/s, or a blend above 1 m.
[[nodiscard]] std::string fanuc_ls(const RobotProgram& program);

}  // namespace glint
