// Reader of joint positions: NumPy array or text.
#pragma once

#include <string>
#include <vector>

namespace glint {

// Returns one position for each of a robot's inputs (RobotModel::inputs). Reads a .npy array of
// float32 or float64, or text: numbers alone in the URDF's order, or lines of joint name and number
// ("elbow: 1.2"). Units: radians and metres. Throws InputError naming file and line for an unknown,
// duplicate or missing joint, a value that is not finite, and too few or too many values.
[[nodiscard]] std::vector<double> read_joint_positions(const std::string& path,
                                                       const std::vector<std::string>& inputs);

}  // namespace glint
