#include "kernels/image/blobs.hpp"

#include <array>

#include "kernels/image/centroid.hpp"
#include "kernels/image/centroid_variance.hpp"
#include "kernels/image/components.hpp"
#include "kernels/image/marker_misfit.hpp"
#include "kernels/image/rescan.hpp"
#include "kernels/merge_sort.hpp"
#include "kernels/shared_budget.hpp"

namespace glint {
namespace {

using Index = std::uint16_t;

// Collects the components inside the size gate, of rescanned ones those with a marker's contrast;
// returns their number.
int gather_candidates(const Frame& frame, const BlobSettings& settings, int rescanned_from,
                      BlobScratch& scratch) {
  int candidates = 0;
  const auto add_if_inside_gate = [&](int i) {
    const std::uint32_t area = scratch.components[static_cast<std::size_t>(i)].area_px;
    scratch.candidate[static_cast<std::size_t>(candidates)] = static_cast<Index>(i);
    candidates += area >= settings.min_area_px && area <= settings.max_area_px ? 1 : 0;
  };
  for (int i = 0; i < rescanned_from; ++i) add_if_inside_gate(i);
  for (int i = rescanned_from; i < scratch.component_count; ++i) {
    if (has_marker_contrast(frame, scratch.components[static_cast<std::size_t>(i)]))
      add_if_inside_gate(i);
  }
  return candidates;
}

void score_candidates(const Frame& frame, const BlobSettings& settings, BlobScratch& scratch,
                      int candidates) {
  for (std::size_t i = 0; i < static_cast<std::size_t>(candidates); ++i) {
    const Component& component = scratch.components[scratch.candidate[i]];
    scratch.misfit[i] = static_cast<std::uint8_t>(marker_misfit(frame, component, settings));
  }
}

// Sorts the candidates by rows: top first, then left first, then by their first run. A key is the
// corner of the box, with the index in the list in its low bits.
void sort_by_rows(BlobScratch& scratch, int candidates) {
  static_assert(k_width_max <= 1 << 10 && k_height_max <= 1 << 10 && k_blobs_max <= 1 << 12);
  std::array<std::uint32_t, k_blobs_max> keys, spare;
  std::array<Index, k_blobs_max> unsorted;
  for (int i = 0; i < candidates; ++i) {
    const auto at = static_cast<std::size_t>(i);
    const Component& component = scratch.components[scratch.candidate[at]];
    keys[at] = static_cast<std::uint32_t>(component.y0) << 22 |
               static_cast<std::uint32_t>(component.x0) << 12 | static_cast<std::uint32_t>(i);
    unsorted[at] = scratch.candidate[at];
  }
  merge_sort(keys, spare, candidates);
  for (std::size_t i = 0; i < static_cast<std::size_t>(candidates); ++i) {
    scratch.candidate[i] = unsorted[keys[i] & ((1u << 12) - 1)];
  }
}

Blob blob_of(const Frame& frame, const Component& component, const Centroid& centroid,
             const BlobSettings& settings) {
  Blob blob;
  blob.centroid_px = centroid.position_px;
  blob.area_px = component.area_px;
  blob.x0 = component.x0;
  blob.y0 = component.y0;
  blob.x1 = component.x1;
  blob.y1 = component.y1;
  blob.peak = centroid.peak;
  const bool cut_x = blob.x0 == 0 || blob.x1 >= frame.width();
  const bool cut_y = blob.y0 == 0 || blob.y1 >= frame.height();
  const bool uneven = is_partial_or_merged(component);
  if (cut_x || cut_y) blob.flags |= k_blob_touches_edge;
  if (blob.peak >= settings.saturated_from) blob.flags |= k_blob_saturated;
  if (centroid.has_bright_rim) blob.flags |= k_blob_has_neighbour;
  if (uneven) blob.flags |= k_blob_partial_or_merged;
  blob.variance_px2 = centroid_variance(centroid, component, settings);
  if (cut_x || cut_y || uneven) {
    const std::array<float, 2> shape = shape_variance(component, cut_x, cut_y);
    blob.variance_px2[0] += shape[0];
    blob.variance_px2[1] += shape[1];
  }
  if (component.level > 0) {
    const std::array<float, 2> surface = surface_variance(frame, centroid, component);
    blob.variance_px2[0] += surface[0];
    blob.variance_px2[1] += surface[1];
  }
  return blob;
}

}  // namespace

BlobWork find_blobs(const Frame& frame, std::span<const Runs* const> bands,
                    const BlobSettings& settings, const BlobSearch& search, BlobScratch& scratch,
                    Blobs& out, const Limits& limits) noexcept {
  out.count = 0;
  out.left_out = 0;
  out.reason = Reason::none;
  for (const Runs* band : bands) {
    if (band->reason != Reason::none) out.reason = band->reason;
  }
  find_components(bands, scratch, limits.runs_per_band);
  const int rescanned_from = scratch.component_count;
  const Rescan rescan = rescan_oversized(frame, settings.max_area_px, runs_of_all_bands_max(limits),
                                         rescan_blocks_max(limits), scratch);
  if (rescan.reason != Reason::none) out.reason = rescan.reason;
  out.incomplete = out.reason;
  BlobWork work;
  work.runs = scratch.run_count;
  work.rescans = rescan.blocks;
  int candidates = gather_candidates(frame, settings, rescanned_from, scratch);
  const int blobs_max = std::clamp(limits.blobs, 0, k_blobs_max);
  if (candidates > blobs_max) {
    out.reason = Reason::blobs_full;
    if (out.incomplete == Reason::none) out.incomplete = Reason::blobs_full;
    out.left_out = static_cast<std::uint32_t>(candidates - blobs_max);
    const auto markers = static_cast<std::size_t>(limits.tools * limits.markers_per_tool);
    BlobSearch within = search;
    within.predicted_px = search.predicted_px.first(std::min(search.predicted_px.size(), markers));
    score_candidates(frame, settings, scratch, candidates);
    work.distances = select_nearest(within, scratch, candidates, blobs_max);
    candidates = blobs_max;
  }
  out.dropped = static_cast<std::uint32_t>(scratch.component_count - candidates);
  sort_by_rows(scratch, candidates);
  SharedBudget budget(limits.centroid_pixels_per_blob, limits.blobs, candidates);
  for (int i = 0; i < candidates; ++i) {
    const Component& component = scratch.components[scratch.candidate[static_cast<std::size_t>(i)]];
    const int pixels_max = budget.next_max();
    const bool small = fits_grown_box(component);
    const int pixels = small ? grown_box(frame, component).pixels() : 0;
    const bool within_budget = pixels <= pixels_max;
    if (within_budget) budget.spend(pixels);
    if (!within_budget) out.reason = Reason::blobs_full;
    const std::uint16_t level = std::max(settings.threshold, component.level);
    const Centroid centroid = small && within_budget
                                  ? grown_centroid(frame, scratch, component, level)
                                  : binary_centroid(frame, scratch, component);
    out.items[static_cast<std::size_t>(out.count++)] =
        blob_of(frame, component, centroid, settings);
  }
  work.blobs = out.count;
  work.pixels = limits.blobs * limits.centroid_pixels_per_blob - budget.left();
  return work;
}

}  // namespace glint
