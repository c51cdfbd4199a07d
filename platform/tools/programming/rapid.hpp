// Post-processor for ABB (RAPID): one module with its own targets, speeds and zones.
//
// Positions in millimetres, quaternions in the order w, x, y, z. Configurations are not monitored
// (ConfL \Off): the controller takes the nearest one.
// Source: ABB, Technical reference manual, RAPID Instructions, Functions and Data types; RAPID
// Kernel (identifiers, reserved words).
#pragma once

#include <string>

#include "platform/tools/programming/robot_program.hpp"

namespace glint {

// Module NAME with the procedure run_NAME. User frame n is the work object wobjN, tool frame n the
// tool toolN; both are the controller's own, and 0 is its base and its flange. T_robot_user is the
// module's own work object pen_frame.
// Throws InputError for a name that is reserved or longer than 28 characters (an identifier has at
// most 32), or an acceleration below 0.1 m/s^2.
[[nodiscard]] std::string rapid(const RobotProgram& program);

}  // namespace glint
