// Planes of reflectivity and depth as files and messages have them, made into a camera's frame.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "platform/sensors/camera.hpp"
#include "platform/sensors/frame_buffer.hpp"

namespace glint {

struct PixelPlane {
  int width = 0, height = 0;
  std::vector<std::uint16_t> values;  // row by row
  std::string name;                   // of its file or topic, for messages
};

// The raw count nearest to a depth, metres; 0, "none", for what no count can state.
[[nodiscard]] std::uint16_t raw_depth(double metres, double unit_m);

// Throws InputError: planes of two sizes, or a reflectivity above what the camera's bits hold.
void fill_pixels(PixelPlane reflectivity, PixelPlane depth, const Camera& camera,
                 FrameBuffer& pixels);

}  // namespace glint
