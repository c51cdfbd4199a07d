// Noise-free image of signal and range, input of the sensor model.
#pragma once

#include <cstddef>
#include <vector>

namespace glint::sim {

struct Planes {
  int width = 0, height = 0;
  std::vector<float> signal;   // counts, not clipped
  std::vector<float> range_m;  // radial, not wrapped; 0: no return

  void resize(int w, int h) {
    width = w;
    height = h;
    signal.resize(static_cast<std::size_t>(w) * static_cast<std::size_t>(h));
    range_m.resize(signal.size());
  }
  [[nodiscard]] std::size_t at(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
           static_cast<std::size_t>(x);
  }
};

}  // namespace glint::sim
