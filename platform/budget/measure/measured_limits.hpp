// Limits for cost measurements: the largest possible, and those of a usual cell.
#pragma once

#include <array>

#include "kernels/limits.hpp"

namespace glint {

// Limits of the built-in cell: five tools of five markers and 64 blobs in a full AHAT frame, a lens
// without a table. One set of costs must cover both this and Limits{}, since costs are per count,
// not per cell.
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
