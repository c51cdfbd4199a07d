#include "platform/tools/mapping/depth_png.hpp"

#include <cstdint>

#include "platform/formats/image_file.hpp"
#include "platform/input_error.hpp"

namespace glint {

DepthFrame read_depth_png(const std::string& path) {
  const Image image = read_png(path, "a PNG with one plane of 16 bits");
  if (image.channels != 1 || image.bits != 16) {
    throw InputError(path +
                     ": not a PNG with one channel of 16 bits; expected depth in millimetres");
  }
  if (image.width > k_depth_side_max || image.height > k_depth_side_max) {
    throw InputError(path + ": " + std::to_string(image.width) + " x " +
                     std::to_string(image.height) + " pixels; expected 1 to " +
                     std::to_string(k_depth_side_max) + " a side");
  }
  DepthFrame out{image.width, image.height, {}, {}, {}};
  out.depth_m.reserve(image.values.size());
  for (const std::uint16_t value : image.values) {
    out.depth_m.push_back(1e-3f * static_cast<float>(value));
  }
  return out;
}

DepthSequence load_depth_sequence(const std::string& folder) {
  return read_depth_sequence(folder, read_depth_png);
}

}  // namespace glint
