// The problems that costs are measured on: the largest there is, and a usual cell's.
#pragma once

#include <array>

#include "kernels/limits.hpp"

namespace glint {

// Five tools of five markers and 64 blobs in a whole AHAT frame, a lens without a table: the
// built-in cell's budgets. One set of costs has to cover both this and Limits{}, as costs are of a
// count and not of a cell.
[[nodiscard]] constexpr Limits measured_cell_limits() {
  Limits limits;
  limits.tools = 5;
  limits.blobs = 64;
  limits.markers_per_tool = 5;
  limits.runs_per_band = 512;
  limits.lens_steps = 0;
  limits.ray_steps = 6;
  limits.search_steps = 768;
  return limits;
}

[[nodiscard]] constexpr std::array<Limits, 2> measured_limits() {
  return {Limits{}, measured_cell_limits()};
}

}  // namespace glint
