// Reader of ROS camera calibrations: sensor_msgs/CameraInfo or a camera_calibration file, as YAML.
#pragma once

#include <string>

#include "kernels/pose/camera_model.hpp"

namespace glint {

// Reads width, height, k (or K, or camera_matrix), d (or D, or distortion_coefficients) and the
// distortion model plumb_bob or rational_polynomial. ROS places pixel centres at integers; the
// returned model at integer + 0.5. Throws InputError naming file and line.
[[nodiscard]] CameraModel read_camera_info(const std::string& path);

// Returns the message's frame (header: frame_id); empty if there is none, as in a calibration file.
// Throws InputError if the file cannot be read.
[[nodiscard]] std::string read_camera_frame(const std::string& path);

}  // namespace glint
