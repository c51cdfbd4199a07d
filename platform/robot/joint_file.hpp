// Joint positions from a file: of NumPy, or as text.
#pragma once

#include <string>
#include <vector>

namespace glint {

// One position for each of a robot's inputs (RobotModel::inputs). A .npy array of float32 or
// float64; else text: either numbers alone, in the URDF's order, or lines of a joint's name and its
// number ("elbow: 1.2"). Radians and metres. Throws InputError naming file and line: an unknown
// joint, one twice or missing, a value that is not finite, too few or too many.
[[nodiscard]] std::vector<double> read_joint_positions(const std::string& path,
                                                       const std::vector<std::string>& inputs);

}  // namespace glint
