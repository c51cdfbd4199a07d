// A surface as triangles, and a camera without a lens: what a model is rendered with.
#pragma once

#include "kernels/geometry.hpp"

namespace glint {

using Vector3f = Eigen::Vector3f;

struct Triangle {
  Vector3f a, b, c;  // metres
};

// Pixel centres at integer + 0.5; fx to cy in pixels.
struct Pinhole {
  int width = 0, height = 0;
  double fx = 0, fy = 0, cx = 0, cy = 0;
};

}  // namespace glint
