// Writes a path as CSV for spreadsheets and pandas: one row per point, with covariance.
#pragma once

#include <string>

#include "platform/tools/programming/path.hpp"

namespace glint {

// Columns: element (from 1), kind, point (from 1 in its element), time_s on the recording's clock,
// x_m y_m z_m, qx qy qz qw of T_robot_tip, then the covariance row by row, c11 to c66: x, y, z [m],
// rotation about the robot's fixed axes x, y, z [rad]. Numbers read back bit-identical.
[[nodiscard]] std::string path_csv(const DrawnPath& path);

}  // namespace glint
