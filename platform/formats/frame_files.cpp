#include "platform/formats/frame_files.hpp"

#include <cstdint>

#include "kernels/limits.hpp"
#include "platform/formats/image_file.hpp"
#include "platform/input_error.hpp"
#include "platform/read_file.hpp"

namespace glint {
namespace {

constexpr int k_side = 512;
constexpr std::size_t k_pixels = std::size_t{k_side} * k_side;

// The frame published with analogdevicesinc/ToF (dcd0bed): its two planes are misaligned.
constexpr int k_adi_brightness_offset_px = 32;
constexpr std::size_t k_adi_pixel_bytes = 5;

std::string read_exactly(const std::string& path, std::size_t expected, const std::string& what) {
  std::string bytes = read_file(path, k_data_bytes_max, what);
  if (bytes.size() != expected) {
    throw InputError(path + ": " + std::to_string(bytes.size()) + " bytes; expected " +
                     std::to_string(expected) + ", " + what);
  }
  return bytes;
}

std::uint16_t little_endian(const std::string& bytes, std::size_t at) {
  const auto low = static_cast<std::uint8_t>(bytes[at]);
  const auto high = static_cast<std::uint8_t>(bytes[at + 1]);
  return static_cast<std::uint16_t>(low | high << 8);
}

FrameBuffer square_buffer() {
  FrameBuffer buffer;
  buffer.width = buffer.height = k_side;
  buffer.depth.resize(k_pixels);
  buffer.reflectivity_16.resize(k_pixels);
  return buffer;
}

FrameBuffer load_adi(const std::string& path) {
  const std::string bytes =
      read_exactly(path, k_pixels * k_adi_pixel_bytes, "512 x 512 pixels of 5 bytes (layout adi)");
  FrameBuffer buffer = square_buffer();
  for (std::size_t y = 0; y < k_side; ++y) {
    for (std::size_t x = 0; x < k_side; ++x) {
      const std::size_t pixel = y * k_side + x;
      buffer.depth[pixel] = little_endian(bytes, pixel * k_adi_pixel_bytes);
      if (x + k_adi_brightness_offset_px >= k_side) continue;
      const std::size_t shifted = (pixel + k_adi_brightness_offset_px) * k_adi_pixel_bytes;
      buffer.reflectivity_16[pixel] = little_endian(bytes, shifted + 3);
    }
  }
  return buffer;
}

FrameBuffer load_ahat(const std::string& path) {
  const std::string bytes = read_exactly(
      path, k_pixels * 4, "512 x 512 of depth u16, then 512 x 512 of brightness u16 (layout ahat)");
  FrameBuffer buffer = square_buffer();
  for (std::size_t i = 0; i < k_pixels; ++i) {
    buffer.depth[i] = little_endian(bytes, 2 * i);
    buffer.reflectivity_16[i] = little_endian(bytes, 2 * (k_pixels + i));
  }
  return buffer;
}

bool ends_with(const std::string& text, const std::string& end) {
  return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

FrameBuffer load_pgm_pair(const std::string& path) {
  if (!ends_with(path, ".pgm")) {
    throw InputError(path + ": name does not end in .pgm; expected NAME.pgm beside NAME_ab.pgm");
  }
  const std::string ending = "_ab.pgm";
  const std::string name = ends_with(path, ending) ? path.substr(0, path.size() - ending.size())
                                                   : path.substr(0, path.size() - 4);
  const PgmLimits limits{k_width_max, k_height_max, 16};
  Image depth = read_pgm(name + ".pgm", limits);
  Image brightness = read_pgm(name + ending, limits);
  if (depth.width != brightness.width || depth.height != brightness.height) {
    throw InputError(name + ending + ": " + std::to_string(brightness.width) + " x " +
                     std::to_string(brightness.height) + "; expected " +
                     std::to_string(depth.width) + " x " + std::to_string(depth.height) +
                     " as in " + name + ".pgm");
  }
  FrameBuffer buffer;
  buffer.width = depth.width;
  buffer.height = depth.height;
  buffer.depth = std::move(depth.values);
  buffer.reflectivity_16 = std::move(brightness.values);
  return buffer;
}

}  // namespace

std::string ahat_bytes(const Frame& frame, const std::string& what) {
  if (frame.width() != k_side || frame.height() != k_side || frame.reflectivity_16.empty()) {
    throw InputError(what + ": " + std::to_string(frame.width()) + " x " +
                     std::to_string(frame.height()) +
                     " pixels; expected 512 x 512 with 16 bits of brightness (hololens2_ahat)");
  }
  std::string bytes(4 * k_pixels, '\0');
  for (std::size_t i = 0; i < k_pixels; ++i) {
    const std::uint16_t values[] = {frame.depth.pixels[i], frame.reflectivity_16.pixels[i]};
    for (std::size_t plane = 0; plane < 2; ++plane) {
      bytes[2 * (plane * k_pixels + i)] = static_cast<char>(values[plane] & 0xFF);
      bytes[2 * (plane * k_pixels + i) + 1] = static_cast<char>(values[plane] >> 8);
    }
  }
  return bytes;
}

FrameFileLayout frame_file_layout_of(const std::string& name) {
  if (name == "adi") return FrameFileLayout::adi;
  if (name == "ahat") return FrameFileLayout::ahat;
  if (name == "pgm") return FrameFileLayout::pgm;
  throw InputError("--layout:" + name + ": unknown layout; expected adi, ahat or pgm");
}

FrameBuffer load_frame(const std::string& path, FrameFileLayout layout) {
  switch (layout) {
    case FrameFileLayout::adi:
      return load_adi(path);
    case FrameFileLayout::ahat:
      return load_ahat(path);
    case FrameFileLayout::pgm:
      return load_pgm_pair(path);
  }
  throw InputError(path + ": unknown layout; expected adi, ahat or pgm");
}

}  // namespace glint
