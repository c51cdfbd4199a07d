// ROS 2's images and lenses by their messages' bytes: sensor_msgs/Image and CameraInfo.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "platform/sources/planes.hpp"

namespace glint {

struct RosHeader {
  Time stamp;
  std::string frame;
};

// Of any message that begins with one. Throws InputError for bytes that are too short.
[[nodiscard]] RosHeader ros_header_of(std::span<const std::uint8_t> message,
                                      const std::string& topic);

// An image as it lies in its message, which it borrows.
struct RosImageView {
  Time stamp;
  std::string_view frame, encoding;
  int width = 0, height = 0;
  std::size_t pixel_bytes = 0, row_bytes = 0;
  bool metres = false, big_endian = false;
  std::span<const std::uint8_t> rows;
};

// Of mono8, 8UC1, mono16, 16UC1 or 32FC1; takes no heap. Throws InputError: another encoding, rows
// shorter than the width, bytes that are not whole.
[[nodiscard]] RosImageView ros_image_view(std::span<const std::uint8_t> message,
                                          const std::string& topic);
// Row by row, width x height values; of 32FC1, in metres, the raw count that has `unit_m`.
void read_values(const RosImageView& image, double unit_m, std::span<std::uint16_t> values);

struct RosImage {
  RosHeader header;
  PixelPlane plane;
};

// The same with values of its own.
[[nodiscard]] RosImage ros_image_of(std::span<const std::uint8_t> message, double unit_m,
                                    const std::string& topic);

// The CameraInfo that belongs to an image topic by ROS's custom: /ir/image, /ir/camera_info.
[[nodiscard]] std::string camera_info_beside(const std::string& topic);

// The file of `glint calibrate camera` that a CameraInfo amounts to. ROS has pixel centres at whole
// numbers, Glint at half ones. Throws InputError: another distortion model than plumb_bob and
// rational_polynomial, no calibration, binning or a region of interest.
[[nodiscard]] std::string lens_text_of_camera_info(std::span<const std::uint8_t> message,
                                                   const std::string& topic);

}  // namespace glint
