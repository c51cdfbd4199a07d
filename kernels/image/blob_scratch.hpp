// Working memory of find_blobs: as large as the largest frame needs, kept between frames by whoever
// calls, never cleared as a whole.
#pragma once

#include <array>
#include <cstdint>

#include "kernels/image/run.hpp"
#include "kernels/limits.hpp"

namespace glint {

inline constexpr int k_runs_max = k_row_bands * k_runs_per_band_max;

// Runs that touch by a side or a corner.
struct Component {
  std::uint32_t area_px = 0;
  std::uint16_t x0 = 0, y0 = 0, x1 = 0, y1 = 0;  // bounding box, half open
  std::uint16_t first_run = 0, last_run = 0;     // its runs, chained by BlobScratch::next_run
};

// The runs that one touches in the rows above and below it: neighbours in the list, half open.
struct RunNeighbours {
  std::uint16_t above_begin = 0, above_end = 0, below_begin = 0, below_end = 0;
};

struct BlobScratch {
  std::array<Run, k_runs_max> runs;
  std::array<RunNeighbours, k_runs_max> neighbours;
  std::array<std::uint16_t, k_runs_max> next_run;
  std::array<std::uint16_t, k_runs_max> open;       // runs found, their neighbours not yet
  std::array<Component, k_runs_max> components;     // by their first run
  std::array<std::uint16_t, k_runs_max> candidate;  // indices of components inside the size gate
  std::array<std::uint32_t, k_runs_max> distance;   // of a candidate to the nearest prediction
  int run_count = 0;
  int component_count = 0;
};

}  // namespace glint
