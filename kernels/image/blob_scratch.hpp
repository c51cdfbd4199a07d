// Working memory of find_blobs, sized for the largest frame. The caller keeps it between frames; no
// function clears it completely.
#pragma once

#include <array>
#include <cstdint>

#include "kernels/image/run.hpp"
#include "kernels/limits.hpp"

namespace glint {

inline constexpr int k_runs_max = k_row_bands * k_runs_per_band_max;

// Connected component of runs (8-connectivity).
struct Component {
  std::uint32_t area_px = 0;
  std::uint16_t x0 = 0, y0 = 0, x1 = 0, y1 = 0;  // bounding box, half open
  std::uint16_t first_run = 0, last_run = 0;     // its runs, chained by BlobScratch::next_run
  std::uint16_t level = 0;  // threshold of its runs if rescan_oversized() found them, else 0
};

// A run as an interval in row-major order.
struct RasterRun {
  std::uint32_t begin = 0, end = 0;  // row << 16 | column; half open

  [[nodiscard]] int y() const { return static_cast<int>(begin >> 16); }
  [[nodiscard]] int x0() const { return static_cast<int>(begin & 0xFFFF); }
  [[nodiscard]] int x1() const { return static_cast<int>(end & 0xFFFF); }
};

struct BlobScratch {
  std::array<RasterRun, k_runs_max> runs;
  std::array<std::uint16_t, k_runs_max> parent;  // union-find: of a run, an earlier connected run
                                                 // or itself; finally its component
  std::array<std::uint16_t, k_runs_max> next_run;
  std::array<Component, k_runs_max> components;     // in order of their first run; see rescan.hpp
  std::array<std::uint16_t, k_runs_max> candidate;  // indices of components inside the size gate
  std::array<std::uint8_t, k_runs_max> misfit;      // of a candidate: marker_misfit()
  std::array<std::int32_t, k_runs_max> distance;    // of a candidate to a prediction or the focus
  int run_count = 0;
  int component_count = 0;
};

// Calls visit(run) for each of the component's runs, at most k_runs_max.
template <class Visit>
void for_each_run(const BlobScratch& scratch, const Component& component, Visit visit) {
  std::uint16_t index = component.first_run;
  for (int i = 0; i < k_runs_max; ++i) {
    visit(scratch.runs[index]);
    if (index == component.last_run) return;
    index = scratch.next_run[index];
  }
}

}  // namespace glint
