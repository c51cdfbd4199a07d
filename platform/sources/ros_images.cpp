#include "platform/sources/ros_images.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <vector>

#include "platform/formats/image_file.hpp"
#include "platform/input_error.hpp"
#include "platform/printable.hpp"
#include "platform/sinks/record/cdr.hpp"
#include "platform/sinks/record/message_parts.hpp"

namespace glint {
namespace {

constexpr std::size_t k_distortion_max = 64;  // coefficients in a CameraInfo

[[noreturn]] void fail(const std::string& topic, const std::string& found,
                       const std::string& expected) {
  throw InputError(topic + ": " + found + "; expected " + expected);
}

RosHeader header_of(CdrReader& from) {
  RosHeader header;
  header.stamp = stamp_of(from);
  header.frame = printable(from.get_text());
  return header;
}

struct Encoding {
  std::string_view name;
  std::size_t bytes;  // per pixel
  bool metres;
};
constexpr Encoding k_encodings[] = {{"mono8", 1, false},
                                    {"8UC1", 1, false},
                                    {"mono16", 2, false},
                                    {"16UC1", 2, false},
                                    {"32FC1", 4, true}};

std::uint32_t number_at(const std::uint8_t* at, std::size_t bytes, bool big_endian) {
  std::uint32_t value = 0;
  for (std::size_t k = 0; k < bytes; ++k) {
    value = value << 8 | at[big_endian ? k : bytes - 1 - k];
  }
  return value;
}

double distorted_radius(double r, const std::array<double, 8>& d) {
  const double r2 = r * r;
  return r * (1 + r2 * (d[0] + r2 * (d[1] + r2 * d[4]))) /
         (1 + r2 * (d[5] + r2 * (d[6] + r2 * d[7])));
}

// Returns the tangent of the field angle up to which the distorted radius increases, limited to the
// image's farthest corner. Beyond it the polynomials are invalid.
double field_tangent_of(const std::array<double, 8>& d, double corner) {
  constexpr double step = 1e-3, farthest = 10;
  double r = 0, radius = 0;
  while (r < farthest && radius < corner) {
    const double next = distorted_radius(r + step, d);
    if (!(next > radius)) break;
    radius = next;
    r += step;
  }
  return r;
}

}  // namespace

RosHeader ros_header_of(std::span<const std::uint8_t> message, const std::string& topic) {
  CdrReader from(message);
  RosHeader header = header_of(from);
  if (from.failed()) fail(topic, "an incomplete message", "the fields of its type");
  return header;
}

RosImageView ros_image_view(std::span<const std::uint8_t> message, const std::string& topic) {
  CdrReader from(message);
  RosImageView image;
  image.stamp = stamp_of(from);
  image.frame = from.get_text_view();
  const auto height = from.get<std::uint32_t>(), width = from.get<std::uint32_t>();
  image.encoding = from.get_text_view();
  image.big_endian = from.get<std::uint8_t>() != 0;
  image.row_bytes = from.get<std::uint32_t>();
  image.rows = from.get_bytes();
  if (from.failed()) fail(topic, "an incomplete image", "the fields of sensor_msgs/Image");
  const auto encoding =
      std::find_if(std::begin(k_encodings), std::end(k_encodings),
                   [&](const Encoding& known) { return known.name == image.encoding; });
  if (encoding == std::end(k_encodings)) {
    fail(topic, "encoding \"" + printable(std::string(image.encoding.substr(0, 32))) + "\"",
         "mono8, 8UC1, mono16, 16UC1 or 32FC1");
  }
  image.pixel_bytes = encoding->bytes;
  image.metres = encoding->metres;
  if (width > k_image_side_max || height > k_image_side_max ||
      image.row_bytes < width * image.pixel_bytes ||
      image.rows.size() != std::uint64_t{image.row_bytes} * height) {
    fail(topic,
         std::to_string(width) + " x " + std::to_string(height) + " pixels of " +
             std::string(encoding->name) + ", " + std::to_string(image.row_bytes) +
             " bytes a row and " + std::to_string(image.rows.size()) + " in all",
         "rows of exactly these pixels");
  }
  image.width = static_cast<int>(width);
  image.height = static_cast<int>(height);
  return image;
}

void read_values(const RosImageView& image, double unit_m, std::span<std::uint16_t> values) {
  const auto width = static_cast<std::size_t>(image.width);
  const bool as_in_memory =
      image.pixel_bytes == 2 && image.big_endian == (std::endian::native == std::endian::big);
  for (std::size_t y = 0; y < static_cast<std::size_t>(image.height); ++y) {
    const std::uint8_t* at = image.rows.data() + y * image.row_bytes;
    std::uint16_t* to = values.data() + y * width;
    if (as_in_memory) {
      std::memcpy(to, at, 2 * width);
      continue;
    }
    for (std::size_t x = 0; x < width; ++x, at += image.pixel_bytes) {
      const std::uint32_t value = number_at(at, image.pixel_bytes, image.big_endian);
      to[x] = image.metres ? raw_depth(double{std::bit_cast<float>(value)}, unit_m)
                           : static_cast<std::uint16_t>(value);
    }
  }
}

RosImage ros_image_of(std::span<const std::uint8_t> message, double unit_m,
                      const std::string& topic) {
  const RosImageView view = ros_image_view(message, topic);
  RosImage image;
  image.header = {view.stamp, printable(std::string(view.frame))};
  image.plane = {view.width, view.height, {}, topic};
  image.plane.values.resize(static_cast<std::size_t>(view.width) *
                            static_cast<std::size_t>(view.height));
  read_values(view, unit_m, image.plane.values);
  return image;
}

std::string camera_info_topic_of(const std::string& topic) {
  return topic.substr(0, topic.rfind('/') + 1) + "camera_info";
}

std::string lens_text_of_camera_info(std::span<const std::uint8_t> message,
                                     const std::string& topic) {
  CdrReader from(message);
  (void)header_of(from);
  const auto height = from.get<std::uint32_t>(), width = from.get<std::uint32_t>();
  const std::string model = from.get_text();
  const auto count = from.get<std::uint32_t>();
  std::array<double, 8> d{};
  if (count > k_distortion_max) fail(topic, "an incomplete CameraInfo", "its fields");
  for (std::uint32_t i = 0; i < count; ++i) {
    const auto value = from.get<double>();
    if (i < d.size()) d[i] = value;
  }
  std::array<double, 9 + 9 + 12> matrices{};  // k, r, p
  for (double& value : matrices) value = from.get<double>();
  std::array<std::uint32_t, 6> region{};  // binning x, y; offset x, y; height, width
  for (std::uint32_t& value : region) value = from.get<std::uint32_t>();
  if (from.failed()) fail(topic, "an incomplete CameraInfo", "its fields");
  const bool plumb_bob = model == "plumb_bob" && count <= 5;
  if (!plumb_bob && !(model == "rational_polynomial" && count == 8)) {
    fail(topic,
         "distortion \"" + printable(model.substr(0, 32)) + "\" with " + std::to_string(count) +
             " numbers",
         "plumb_bob with 5 or rational_polynomial with 8, or a lens in the cell");
  }
  if (region[0] > 1 || region[1] > 1 || region[2] > 0 || region[3] > 0) {
    fail(topic, "binning or a region of interest", "complete images");
  }
  const double fx = matrices[0], fy = matrices[4], cx = matrices[2], cy = matrices[5];
  if (!(fx >= 1) || !(fy >= 1) || !std::isfinite(cx + cy) ||
      !std::all_of(d.begin(), d.end(), [](double value) { return std::isfinite(value); })) {
    fail(topic, "no calibration", "a focal length in k, or a lens in the cell");
  }
  const double across = std::max(cx + 1, width - cx) / fx,
               down = std::max(cy + 1, height - cy) / fy;
  char text[1024];
  std::snprintf(text, sizeof text,
                "[camera]\nlens = \"%s\"\nwidth = %u\nheight = %u\nfx_px = %.17g\nfy_px = %.17g\n"
                "cx_px = %.17g\ncy_px = %.17g\nk1_k2_p1_p2_k3_k4_k5_k6 = [%.17g, %.17g, %.17g, "
                "%.17g, %.17g, %.17g, %.17g, %.17g]\nfield_tangent = %.17g\n",
                plumb_bob ? "brown" : "rational", width, height, fx, fy, cx + 0.5, cy + 0.5, d[0],
                d[1], d[2], d[3], d[4], d[5], d[6], d[7],
                field_tangent_of(d, std::sqrt(across * across + down * down)));
  return text;
}

}  // namespace glint
