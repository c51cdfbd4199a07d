// ROS 2's images and lenses by their messages' bytes: sensor_msgs/Image and CameraInfo.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "platform/sources/planes.hpp"

namespace glint {

struct RosHeader {
  Time stamp;
  std::string frame;
};

// Of any message that begins with one. Throws InputError for bytes that are too short.
[[nodiscard]] RosHeader ros_header_of(std::span<const std::uint8_t> message,
                                      const std::string& topic);

struct RosImage {
  RosHeader header;
  PixelPlane plane;
};

// mono8, 8UC1, mono16, 16UC1, 32FC1; the last in metres, of which a raw count has `unit_m`.
// Throws InputError: another encoding, rows shorter than the width, bytes that are not whole.
[[nodiscard]] RosImage ros_image_of(std::span<const std::uint8_t> message, double unit_m,
                                    const std::string& topic);

// The file of `glint calibrate camera` that a CameraInfo amounts to. ROS has pixel centres at whole
// numbers, Glint at half ones. Throws InputError: another distortion model than plumb_bob and
// rational_polynomial, no calibration, binning or a region of interest.
[[nodiscard]] std::string lens_text_of_camera_info(std::span<const std::uint8_t> message,
                                                   const std::string& topic);

}  // namespace glint
