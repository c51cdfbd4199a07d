#include "kernels/image/components.hpp"

#include <algorithm>

namespace glint {
namespace {

using Index = std::uint16_t;

static_assert(k_runs_max <= 0xFFFF);

constexpr std::uint32_t k_row = 1u << 16;

RasterRun raster_run(const Run& run) {
  const std::uint32_t row = run.y * k_row;
  return {row | run.x0, row | run.x1};
}

// Union-find search for the root (first connected run so far) with path halving.
Index root_of(BlobScratch& scratch, Index run) {
  Index parent = scratch.parent[run];
  while (parent != run) {
    const Index above = scratch.parent[parent];
    scratch.parent[run] = above;
    run = above;
    parent = scratch.parent[run];
  }
  return run;
}

// Joins each run with all runs that it touches in the row above.
void join_runs(std::span<const Runs* const> bands, BlobScratch& scratch, int runs_per_band) {
  const std::size_t band_count = std::min<std::size_t>(bands.size(), k_row_bands);
  const int runs_max = std::clamp(runs_per_band, 0, k_runs_per_band_max);
  RasterRun* const runs = scratch.runs.data();
  int count = 0;
  int above = 0;  // first run that may still touch; runs of the same row never touch
  for (std::size_t band = 0; band < band_count; ++band) {
    const int in_band = std::clamp(bands[band]->count, 0, runs_max);
    for (int i = 0; i < in_band; ++i) {
      const RasterRun run = raster_run(bands[band]->items[static_cast<std::size_t>(i)]);
      const auto self = static_cast<Index>(count++);
      runs[self] = run;
      scratch.parent[self] = self;
      while (runs[above].end + k_row < run.begin) ++above;
      int j = above;
      if (runs[j].begin + k_row > run.end) continue;
      Index root = root_of(scratch, static_cast<Index>(j));
      for (++j; runs[j].begin + k_row <= run.end; ++j) {
        const Index other = root_of(scratch, static_cast<Index>(j));
        if (other == root) continue;
        scratch.parent[std::max(root, other)] = std::min(root, other);
        root = std::min(root, other);
      }
      scratch.parent[self] = root;
    }
  }
  scratch.run_count = count;
}

// A parent precedes its runs, so its component exists before they are assigned to it.
void gather_components(BlobScratch& scratch) {
  const int run_count = scratch.run_count;
  int count = 0;
  for (int i = 0; i < run_count; ++i) {
    const auto self = static_cast<Index>(i);
    const RasterRun run = scratch.runs[self];
    const auto y0 = static_cast<std::uint16_t>(run.y()), y1 = static_cast<std::uint16_t>(y0 + 1);
    const auto x0 = static_cast<std::uint16_t>(run.x0()), x1 = static_cast<std::uint16_t>(run.x1());
    const std::uint32_t length = run.end - run.begin;
    const Index parent = scratch.parent[self];
    if (parent == self) {
      scratch.parent[self] = static_cast<Index>(count);
      scratch.components[static_cast<Index>(count++)] = {length, x0, y0, x1, y1, self, self};
      continue;
    }
    const Index index = scratch.parent[parent];
    scratch.parent[self] = index;
    Component& component = scratch.components[index];
    component.area_px += length;
    component.x0 = std::min(component.x0, x0);
    component.x1 = std::max(component.x1, x1);
    component.y1 = y1;
    scratch.next_run[component.last_run] = self;
    component.last_run = self;
  }
  scratch.component_count = count;
}

}  // namespace

void find_components(std::span<const Runs* const> bands, BlobScratch& scratch,
                     int runs_per_band) noexcept {
  join_runs(bands, scratch, runs_per_band);
  gather_components(scratch);
}

}  // namespace glint
