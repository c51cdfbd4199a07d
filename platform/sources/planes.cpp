#include "platform/sources/planes.hpp"

#include <cmath>
#include <limits>
#include <utility>

#include "platform/input_error.hpp"

namespace glint {

std::uint16_t raw_depth(double metres, double unit_m) {
  constexpr double most = std::numeric_limits<std::uint16_t>::max();
  const double raw = std::round(metres / unit_m);
  return raw >= 0 && raw <= most ? static_cast<std::uint16_t>(raw) : 0;
}

void fill_pixels(PixelPlane reflectivity, PixelPlane depth, const Camera& camera,
                 FrameBuffer& pixels) {
  if (depth.width != reflectivity.width || depth.height != reflectivity.height) {
    throw InputError(depth.name + ": size differs from " + reflectivity.name +
                     "; expected equal sizes");
  }
  pixels.width = reflectivity.width;
  pixels.height = reflectivity.height;
  pixels.depth = std::move(depth.values);
  pixels.reflectivity_8.clear();
  pixels.reflectivity_16.clear();
  if (camera.reflectivity_bits > 8) {
    pixels.reflectivity_16 = std::move(reflectivity.values);
    return;
  }
  pixels.reflectivity_8.reserve(reflectivity.values.size());
  for (const std::uint16_t value : reflectivity.values) {
    if (value > 255) {
      throw InputError(reflectivity.name + ": a value of " + std::to_string(value) +
                       "; expected at most 255 (" + camera.name + ")");
    }
    pixels.reflectivity_8.push_back(static_cast<std::uint8_t>(value));
  }
}

}  // namespace glint
