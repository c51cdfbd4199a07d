// Triangle mesh and pinhole camera without lens distortion, for the rendering of a model.
#pragma once

#include <cstdint>
#include <span>

#include "kernels/geometry.hpp"

namespace glint {

using Vector3f = Eigen::Vector3f;

struct Triangle {
  Vector3f a, b, c;  // metres
};

// Indexed triangle mesh. Borrowed.
struct Face {
  std::int32_t a = 0, b = 0, c = 0;  // indices of corners
};
struct Surface {
  std::span<const Vector3f> corners;  // metres
  std::span<const Face> faces;

  [[nodiscard]] Triangle triangle(std::size_t face) const {
    const Face& f = faces[face];
    return {corners[static_cast<std::size_t>(f.a)], corners[static_cast<std::size_t>(f.b)],
            corners[static_cast<std::size_t>(f.c)]};
  }
};

// Pixel centres at integer + 0.5; fx to cy in pixels.
struct Pinhole {
  int width = 0, height = 0;
  double fx = 0, fy = 0, cx = 0, cy = 0;
};

}  // namespace glint
