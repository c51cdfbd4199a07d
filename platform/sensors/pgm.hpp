// Binary PGM pictures (P5) with 16 bits a pixel, big-endian as the format demands.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace glint {

struct Pgm {
  int width = 0;
  int height = 0;
  std::vector<std::uint16_t> pixels;
};

// At most k_width_max x k_height_max, maxval 256 to 65535.
// Throws InputError naming the file, the place, what was found and expected.
[[nodiscard]] Pgm read_pgm_16(const std::string& path);

}  // namespace glint
