// Bright pixels of one row, run-length coded.
#pragma once

#include <array>
#include <cstdint>

#include "kernels/limits.hpp"
#include "kernels/reason.hpp"

namespace glint {

struct Run {
  std::uint16_t y = 0, x0 = 0, x1 = 0;  // pixels x0 <= x < x1 of row y
};

// The runs of one band of rows, in row order and, within a row, from left to right.
struct Runs {
  std::array<Run, k_runs_per_band_max> items;
  int count = 0;
  Reason reason = Reason::none;  // runs_full: the band holds more than these, its first ones
};

}  // namespace glint
