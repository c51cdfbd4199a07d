#include "kernels/image/components.hpp"

#include <algorithm>

namespace glint {
namespace {

using Index = std::uint16_t;

Index root_of(BlobScratch& scratch, Index run) {
  while (scratch.parent[run] != run) {
    scratch.parent[run] = scratch.parent[scratch.parent[run]];
    run = scratch.parent[run];
  }
  return run;
}

// The smaller index becomes the root: a component is found where its first run stands.
void join(BlobScratch& scratch, Index a, Index b) {
  const Index root_a = root_of(scratch, a), root_b = root_of(scratch, b);
  if (root_a < root_b) scratch.parent[root_b] = root_a;
  if (root_b < root_a) scratch.parent[root_a] = root_b;
}

void gather_runs(std::span<const Runs* const> bands, BlobScratch& scratch) {
  scratch.run_count = 0;
  const std::size_t band_count = std::min<std::size_t>(bands.size(), k_row_bands);
  for (std::size_t band = 0; band < band_count; ++band) {
    const int count = std::clamp(bands[band]->count, 0, k_runs_per_band_max);
    std::copy_n(bands[band]->items.begin(), count, scratch.runs.begin() + scratch.run_count);
    scratch.run_count += count;
  }
}

void join_neighbours(BlobScratch& scratch) {
  int above = 0;  // first run of the row above that may still touch
  for (int i = 0; i < scratch.run_count; ++i) {
    const auto index = static_cast<Index>(i);
    const Run& run = scratch.runs[index];
    scratch.parent[index] = index;
    while (above < i && (scratch.runs[static_cast<Index>(above)].y + 1 < run.y ||
                         (scratch.runs[static_cast<Index>(above)].y + 1 == run.y &&
                          scratch.runs[static_cast<Index>(above)].x1 < run.x0))) {
      ++above;
    }
    for (int j = above; j < i; ++j) {
      const Run& upper = scratch.runs[static_cast<Index>(j)];
      if (upper.y + 1 != run.y || upper.x0 > run.x1) break;
      join(scratch, static_cast<Index>(j), index);
    }
  }
}

}  // namespace

void find_components(std::span<const Runs* const> bands, BlobScratch& scratch) noexcept {
  gather_runs(bands, scratch);
  join_neighbours(scratch);
  scratch.component_count = 0;
  // Roots come before their other runs, so `candidate` can hold each root's component by then.
  for (int i = 0; i < scratch.run_count; ++i) {
    const auto index = static_cast<Index>(i);
    const Run& run = scratch.runs[index];
    const Index root = root_of(scratch, index);
    scratch.next_run[index] = index;
    const auto length = static_cast<std::uint32_t>(run.x1 - run.x0);
    const auto bottom = static_cast<std::uint16_t>(run.y + 1);
    if (root == index) {
      const auto fresh = static_cast<Index>(scratch.component_count++);
      scratch.candidate[index] = fresh;
      scratch.components[fresh] = {length, run.x0, run.y, run.x1, bottom, index, index};
      continue;
    }
    Component& component = scratch.components[scratch.candidate[root]];
    component.area_px += length;
    component.x0 = std::min(component.x0, run.x0);
    component.x1 = std::max(component.x1, run.x1);
    component.y1 = std::max(component.y1, bottom);
    scratch.next_run[component.last_run] = index;
    component.last_run = index;
  }
}

}  // namespace glint
