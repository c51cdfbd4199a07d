// One camera frame: views of its pixels, with time stamps.
#pragma once

#include <cstdint>

#include "kernels/units.hpp"

namespace glint {

// Non-owning view of an image: row-major from the top left, without padding between rows.
template <class Pixel>
struct ImageView {
  const Pixel* pixels = nullptr;
  int width = 0;
  int height = 0;
  [[nodiscard]] const Pixel* row(int y) const {
    return pixels + static_cast<std::ptrdiff_t>(y) * width;
  }
  [[nodiscard]] bool empty() const { return pixels == nullptr; }
};

// Exactly one of the two reflectivity planes is set; depth may be absent. Depth is in the sensor's
// raw unit (see DepthSettings); 0 is an invalid pixel.
struct Frame {
  Time mid_exposure;     // the time of every measurement of this frame
  Duration stamp_sigma;  // of mid_exposure, from the clock estimate; 0: time stamp of this clock
  Time arrival;          // of the last byte in memory; only for latency figures
  std::uint64_t sequence = 0;
  ImageView<std::uint8_t> reflectivity_8;
  ImageView<std::uint16_t> reflectivity_16;
  ImageView<std::uint16_t> depth;

  [[nodiscard]] int width() const {
    return reflectivity_8.empty() ? reflectivity_16.width : reflectivity_8.width;
  }
  [[nodiscard]] int height() const {
    return reflectivity_8.empty() ? reflectivity_16.height : reflectivity_8.height;
  }
};

}  // namespace glint
