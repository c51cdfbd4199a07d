// Regions of interest (ROI) of a frame: disjoint rectangles, half open, in pixels.
#pragma once

#include <array>

#include "kernels/limits.hpp"

namespace glint {

struct Roi {
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;  // x0 <= x < x1, y0 <= y < y1
};

struct Rois {
  std::array<Roi, k_tools_max> items;
  int count = 0;
};

}  // namespace glint
