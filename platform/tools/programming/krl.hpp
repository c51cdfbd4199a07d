// Post-processor for KUKA (KRL): one .src file with the poses as aggregates.
//
// X, Y, Z in millimetres; A, B, C in degrees about the moving axes z, y, x. The program starts at
// the robot's position ($AXIS_ACT) and moves from there on straight lines.
// Source: KUKA System Software 8.3, Operating and Programming Instructions for System Integrators.
#pragma once

#include <string>

#include "platform/tools/programming/robot_program.hpp"

namespace glint {

// User frame 0 is $NULLFRAME, n is BASE_DATA[n] (to 32), T_robot_user is an aggregate; tool frame n
// is TOOL_DATA[n] (to 16). The controller expects the file NAME.src.
// Throws InputError for a number outside of these or a name longer than 24 characters or reserved.
[[nodiscard]] std::string krl(const RobotProgram& program);

}  // namespace glint
