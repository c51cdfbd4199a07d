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

// Copies the runs of all bands to the scratch.
void gather_runs(std::span<const Runs* const> bands, BlobScratch& scratch, int runs_per_band) {
  const std::size_t band_count = std::min<std::size_t>(bands.size(), k_row_bands);
  const int runs_max = std::clamp(runs_per_band, 0, k_runs_per_band_max);
  std::size_t count = 0;
  for (std::size_t band = 0; band < band_count; ++band) {
    const int in_band = std::clamp(bands[band]->count, 0, runs_max);
    for (int i = 0; i < in_band; ++i)
      scratch.runs[count++] = raster_run(bands[band]->items[static_cast<std::size_t>(i)]);
  }
  scratch.run_count = static_cast<int>(count);
}

// Joins each run from first_run on with all of these that it touches in the row above.
void join_runs(BlobScratch& scratch, int first_run) {
  const RasterRun* const runs = scratch.runs.data();
  const int count = scratch.run_count;
  int above = first_run;  // first run that may still touch; runs of the same row never touch
  for (int i = first_run; i < count; ++i) {
    const RasterRun run = runs[i];
    const auto self = static_cast<Index>(i);
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

// A parent precedes its runs, so its component exists before they are assigned to it.
void gather_components(BlobScratch& scratch, int first_run, std::uint16_t level) {
  const int run_count = scratch.run_count;
  int count = scratch.component_count;
  for (int i = first_run; i < run_count; ++i) {
    const auto self = static_cast<Index>(i);
    const RasterRun run = scratch.runs[self];
    const auto y0 = static_cast<std::uint16_t>(run.y()), y1 = static_cast<std::uint16_t>(y0 + 1);
    const auto x0 = static_cast<std::uint16_t>(run.x0()), x1 = static_cast<std::uint16_t>(run.x1());
    const std::uint32_t length = run.end - run.begin;
    const Index parent = scratch.parent[self];
    if (parent == self) {
      scratch.parent[self] = static_cast<Index>(count);
      scratch.components[static_cast<Index>(count++)] = {length, x0, y0, x1, y1, self, self, level};
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

void append_components(BlobScratch& scratch, int first_run, std::uint16_t level) noexcept {
  join_runs(scratch, first_run);
  gather_components(scratch, first_run, level);
}

void find_components(std::span<const Runs* const> bands, BlobScratch& scratch,
                     int runs_per_band) noexcept {
  gather_runs(bands, scratch, runs_per_band);
  scratch.component_count = 0;
  append_components(scratch, 0, 0);
}

}  // namespace glint
