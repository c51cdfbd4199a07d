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

// A run by where it begins and ends in the order of rows, then columns.
struct PlacedRun {
  std::uint32_t begin = 0, end = 0;  // row << 16 | column; half open

  [[nodiscard]] int y() const { return static_cast<int>(begin >> 16); }
  [[nodiscard]] int x0() const { return static_cast<int>(begin & 0xFFFF); }
  [[nodiscard]] int x1() const { return static_cast<int>(end & 0xFFFF); }
};

struct BlobScratch {
  std::array<PlacedRun, k_runs_max> runs;
  std::array<std::uint16_t, k_runs_max> parent;  // of a run: an earlier one that it hangs together
                                                 // with, or itself; at last its component
  std::array<std::uint16_t, k_runs_max> next_run;
  std::array<Component, k_runs_max> components;     // by their first run
  std::array<std::uint16_t, k_runs_max> candidate;  // indices of components inside the size gate
  std::array<std::uint8_t, k_runs_max> misfit;      // of a candidate: marker_misfit()
  std::array<std::int32_t, k_runs_max> distance;    // of a candidate to what is looked for
  int run_count = 0;
  int component_count = 0;
};

}  // namespace glint
