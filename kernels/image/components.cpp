#include "kernels/image/components.hpp"

#include <algorithm>

namespace glint {
namespace {

using Index = std::uint16_t;

constexpr Index k_unseen = 0xFFFF;
static_assert(k_runs_max < k_unseen);

void gather_runs(std::span<const Runs* const> bands, BlobScratch& scratch, int runs_per_band) {
  scratch.run_count = 0;
  const std::size_t band_count = std::min<std::size_t>(bands.size(), k_row_bands);
  const int most = std::clamp(runs_per_band, 0, k_runs_per_band_max);
  for (std::size_t band = 0; band < band_count; ++band) {
    const int count = std::clamp(bands[band]->count, 0, most);
    std::copy_n(bands[band]->items.begin(), count, scratch.runs.begin() + scratch.run_count);
    scratch.run_count += count;
  }
}

// Places in the order of rows, then columns.
constexpr std::uint32_t place(unsigned y, unsigned x) { return y << 16 | x; }

void find_neighbours(BlobScratch& scratch) {
  int above = 0;  // first run that may still touch; a run of the same row never does
  for (int i = 0; i < scratch.run_count; ++i) {
    const Run run = scratch.runs[static_cast<Index>(i)];
    const std::uint32_t from = place(run.y, run.x0), to = place(run.y, run.x1);
    const auto begins_below = [&](int j) {
      const Run& upper = scratch.runs[static_cast<Index>(j)];
      return place(upper.y + 1u, upper.x0);
    };
    const auto ends_below = [&](int j) {
      const Run& upper = scratch.runs[static_cast<Index>(j)];
      return place(upper.y + 1u, upper.x1);
    };
    while (ends_below(above) < from) ++above;
    int j = above;
    for (; begins_below(j) <= to; ++j) {
      RunNeighbours& upper = scratch.neighbours[static_cast<Index>(j)];
      upper.below_begin = upper.below_end == 0 ? static_cast<Index>(i) : upper.below_begin;
      upper.below_end = static_cast<Index>(i + 1);
    }
    scratch.neighbours[static_cast<Index>(i)] = {static_cast<Index>(above), static_cast<Index>(j),
                                                 0, 0};
    scratch.next_run[static_cast<Index>(i)] = k_unseen;
  }
}

class Search {
 public:
  explicit Search(BlobScratch& scratch) : scratch_(scratch) {}

  // The component of a run that no other component has.
  [[nodiscard]] Component from(Index first) {
    const Run& top = scratch_.runs[first];
    Component component{0, top.x0, top.y, top.x1, 0, first, first};
    see(first);
    while (open_count_ > 0) {
      const Index index = scratch_.open[--open_count_];
      const Run run = scratch_.runs[index];
      component.area_px += static_cast<std::uint32_t>(run.x1 - run.x0);
      component.x0 = std::min(component.x0, run.x0);
      component.x1 = std::max(component.x1, run.x1);
      component.y1 = std::max<std::uint16_t>(component.y1, static_cast<std::uint16_t>(run.y + 1));
      scratch_.next_run[component.last_run] = index;
      component.last_run = index;
      const RunNeighbours near = scratch_.neighbours[index];
      for (unsigned j = near.above_begin; j < near.above_end; ++j) see(static_cast<Index>(j));
      for (unsigned j = near.below_begin; j < near.below_end; ++j) see(static_cast<Index>(j));
    }
    return component;
  }

 private:
  void see(Index index) {
    if (scratch_.next_run[index] != k_unseen) return;
    scratch_.next_run[index] = index;
    scratch_.open[open_count_++] = index;
  }

  BlobScratch& scratch_;
  std::size_t open_count_ = 0;
};

}  // namespace

void find_components(std::span<const Runs* const> bands, BlobScratch& scratch,
                     int runs_per_band) noexcept {
  gather_runs(bands, scratch, runs_per_band);
  find_neighbours(scratch);
  scratch.component_count = 0;
  Search search(scratch);
  for (int i = 0; i < scratch.run_count; ++i) {
    const auto index = static_cast<Index>(i);
    if (scratch.next_run[index] != k_unseen) continue;
    scratch.components[static_cast<Index>(scratch.component_count++)] = search.from(index);
  }
}

}  // namespace glint
