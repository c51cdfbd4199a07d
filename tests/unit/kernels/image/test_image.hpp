// Test images from text or from rendered discs.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include "kernels/image/frame.hpp"

namespace glint::test {

// Owns the pixels that frame() refers to.
struct TestImage {
  int width = 0, height = 0;
  std::vector<std::uint16_t> pixels_16;
  std::vector<std::uint8_t> pixels_8;  // used if not empty

  TestImage(int w, int h, std::uint16_t value = 0)
      : width(w),
        height(h),
        pixels_16(static_cast<std::size_t>(w) * static_cast<std::size_t>(h), value) {}

  [[nodiscard]] std::size_t at(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
           static_cast<std::size_t>(x);
  }
  std::uint16_t& operator()(int x, int y) { return pixels_16[at(x, y)]; }

  [[nodiscard]] Frame frame() const {
    Frame out;
    if (pixels_8.empty()) {
      out.reflectivity_16 = {pixels_16.data(), width, height};
    } else {
      out.reflectivity_8 = {pixels_8.data(), width, height};
    }
    return out;
  }

  // Returns the same image with 8 bits; values are clipped.
  [[nodiscard]] TestImage with_8_bits() const {
    TestImage out = *this;
    for (const std::uint16_t value : pixels_16) {
      out.pixels_8.push_back(static_cast<std::uint8_t>(std::min<int>(value, 255)));
    }
    return out;
  }
};

// '#' is 1000, any other character 0.
inline TestImage image_of(const std::vector<std::string>& rows) {
  TestImage out(static_cast<int>(rows.front().size()), static_cast<int>(rows.size()));
  for (int y = 0; y < out.height; ++y) {
    for (int x = 0; x < out.width; ++x) {
      if (rows[static_cast<std::size_t>(y)][static_cast<std::size_t>(x)] == '#') out(x, y) = 1000;
    }
  }
  return out;
}

// Sets the pixels x0 <= x < x1, y0 <= y < y1.
inline void add_surface(TestImage& picture, int x0, int y0, int x1, int y1, int value) {
  for (int y = y0; y < y1; ++y)
    for (int x = x0; x < x1; ++x) picture(x, y) = static_cast<std::uint16_t>(value);
}

// Adds a disc of uniform brightness; an edge pixel is the mean of 8 x 8 samples.
inline void add_disc(TestImage& picture, double cx, double cy, double radius, double brightness) {
  const int x0 = std::max(static_cast<int>(cx - radius) - 2, 0);
  const int y0 = std::max(static_cast<int>(cy - radius) - 2, 0);
  const int x1 = std::min(static_cast<int>(cx + radius) + 3, picture.width);
  const int y1 = std::min(static_cast<int>(cy + radius) + 3, picture.height);
  for (int y = y0; y < y1; ++y) {
    for (int x = x0; x < x1; ++x) {
      int inside = 0;
      for (int i = 0; i < 64; ++i) {
        const double dx = x + (i % 8 + 0.5) / 8 - cx, dy = y + (i / 8 + 0.5) / 8 - cy;
        inside += dx * dx + dy * dy <= radius * radius;
      }
      const double value = picture(x, y) + brightness * inside / 64;
      picture(x, y) = static_cast<std::uint16_t>(std::min(value + 0.5, 65535.0));
    }
  }
}

}  // namespace glint::test
