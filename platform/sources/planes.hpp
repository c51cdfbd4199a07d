// Converts planes of reflectivity and depth from files and messages to a camera's frame.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "platform/formats/camera.hpp"
#include "platform/formats/frame_buffer.hpp"

namespace glint {

struct PixelPlane {
  int width = 0, height = 0;
  std::vector<std::uint16_t> values;  // row by row
  std::string name;                   // of its file or topic, for messages
};

// Returns the raw count nearest to a depth in metres; 0 (none) outside of the representable range.
[[nodiscard]] std::uint16_t raw_depth(double metres, double unit_m);

// Throws InputError: planes of different size, or reflectivity beyond the camera's bits.
void fill_pixels(PixelPlane reflectivity, PixelPlane depth, const Camera& camera,
                 FrameBuffer& pixels);

}  // namespace glint
