// Parser of ROS 2 messages with images and lenses: sensor_msgs/Image and CameraInfo.
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

// For any message that begins with a header. Throws InputError if the bytes are too short.
[[nodiscard]] RosHeader ros_header_of(std::span<const std::uint8_t> message,
                                      const std::string& topic);

// View of an image in its message; does not own the bytes.
struct RosImageView {
  Time stamp;
  std::string_view frame, encoding;
  int width = 0, height = 0;
  std::size_t pixel_bytes = 0, row_bytes = 0;
  bool metres = false, big_endian = false;
  std::span<const std::uint8_t> rows;
};

// Accepts mono8, 8UC1, mono16, 16UC1 or 32FC1; allocates no heap. Throws InputError: another
// encoding, rows shorter than the width, incomplete bytes.
[[nodiscard]] RosImageView ros_image_view(std::span<const std::uint8_t> message,
                                          const std::string& topic);
// Writes width x height values row by row; for 32FC1 (metres) the raw count in `unit_m`.
void read_values(const RosImageView& image, double unit_m, std::span<std::uint16_t> values);

struct RosImage {
  RosHeader header;
  PixelPlane plane;
};

// Same, with its own values.
[[nodiscard]] RosImage ros_image_of(std::span<const std::uint8_t> message, double unit_m,
                                    const std::string& topic);

// Returns the CameraInfo topic of an image topic by ROS's convention: /ir/image, /ir/camera_info.
[[nodiscard]] std::string camera_info_topic_of(const std::string& topic);

// Converts a CameraInfo to the text of a file of `glint calibrate camera`. ROS has pixel centres at
// integers, Glint at integers + 0.5. Throws InputError: a distortion model other than plumb_bob and
// rational_polynomial, no calibration, binning or a region of interest.
[[nodiscard]] std::string lens_text_of_camera_info(std::span<const std::uint8_t> message,
                                                   const std::string& topic);

}  // namespace glint
