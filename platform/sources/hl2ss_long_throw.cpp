#include "platform/sources/hl2ss_long_throw.hpp"

#include <cstddef>
#include <string_view>

#include "platform/formats/image_file.hpp"
#include "platform/input_error.hpp"

namespace glint {
namespace {

constexpr std::size_t k_png_size_at = 16;  // of IHDR: u32 width, u32 height, big endian

}  // namespace

std::vector<std::uint8_t> hl2ss_long_throw_planes(std::span<const std::uint8_t> png,
                                                  const Camera& camera, const std::string& name) {
  const auto number = [&](std::size_t at) {
    std::uint32_t value = 0;
    for (std::size_t i = at; i < at + 4; ++i) value = value << 8 | png[i];
    return value;
  };
  const std::string expected = "a PNG image of " + std::to_string(camera.model.width) + " x " +
                               std::to_string(camera.model.height) +
                               " pixels with two planes' bytes as blue, green, red and alpha";
  const auto refuse = [&](std::uint64_t width, std::uint64_t height) {
    throw InputError(name + ": an image of " + std::to_string(width) + " x " +
                     std::to_string(height) + " pixels; expected " + expected + " (" + camera.name +
                     ")");
  };
  if (png.size() < k_png_size_at + 8) refuse(0, 0);
  // Before decoding, which allocates as many pixels as the image states.
  const std::uint32_t width = number(k_png_size_at), height = number(k_png_size_at + 4);
  if (width != static_cast<std::uint32_t>(camera.model.width) ||
      height != static_cast<std::uint32_t>(camera.model.height)) {
    refuse(width, height);
  }
  const Image picture =
      png_of({reinterpret_cast<const char*>(png.data()), png.size()}, name, expected, true);
  if (picture.channels != 4 || picture.bits != 8) refuse(width, height);
  std::vector<std::uint8_t> planes(picture.values.size());
  for (std::size_t i = 0; i < planes.size(); ++i) {  // the file's order is red, green, blue
    const std::size_t channel = i % 4 == 3 ? 3 : 2 - i % 4;
    planes[i] = static_cast<std::uint8_t>(picture.values[i - i % 4 + channel]);
  }
  return planes;
}

}  // namespace glint
