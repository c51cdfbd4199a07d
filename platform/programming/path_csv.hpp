// A path as a table for spreadsheets and pandas: one row a point, covariances with it.
#pragma once

#include <string>

#include "platform/programming/path.hpp"

namespace glint {

// element (from 1), kind, point (from 1 in its element), time_s on the recording's clock, x_m y_m
// z_m, qx qy qz qw of T_robot_tip, and the covariance row by row, c11 to c66: x, y, z [m], rotation
// about the robot's fixed axes x, y, z [rad]. Numbers read back to the same bits.
[[nodiscard]] std::string path_csv(const DrawnPath& path);

}  // namespace glint
