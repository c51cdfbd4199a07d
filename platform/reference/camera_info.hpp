// A camera's calibration as ROS writes it: sensor_msgs/CameraInfo or camera_calibration's file.
#pragma once

#include <string>

#include "kernels/pose/camera_model.hpp"

namespace glint {

// Reads width, height, k (or K, or camera_matrix), d (or D, or distortion_coefficients) and the
// distortion model plumb_bob or rational_polynomial out of YAML. ROS counts pixels' centres as
// integers; the model returned as integer + 0.5. Throws InputError naming file and line.
[[nodiscard]] CameraModel read_camera_info(const std::string& path);

// The frame that such a message names (header: frame_id); empty: none, as in a calibration file.
// Throws InputError where it cannot be read.
[[nodiscard]] std::string read_camera_frame(const std::string& path);

}  // namespace glint
