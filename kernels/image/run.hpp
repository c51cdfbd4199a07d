// Runs of pixels above the threshold (run-length encoding).
#pragma once

#include <array>
#include <cstdint>

#include "kernels/limits.hpp"
#include "kernels/reason.hpp"

namespace glint {

struct Run {
  std::uint16_t y = 0, x0 = 0, x1 = 0;  // pixels x0 <= x < x1 of row y
};

// The runs of one band of rows, in row-major order.
struct Runs {
  std::array<Run, k_runs_per_band_max> items;
  int count = 0;
  Reason reason = Reason::none;  // runs_full: the band has more runs; these are its first ones
};

}  // namespace glint
