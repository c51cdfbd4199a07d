// Blob detection from runs: connected components inside the size gate, with sub-pixel centroids.
//
// What:     connected components inside the size gate, each with a sub-pixel centroid and variance;
//           those beyond the gate are searched again at a higher level (rescan.hpp).
//           If more than limits.blobs are found, nearest_candidates.hpp selects those to keep: near
//           predicted markers, near a focus that changes with the frame, with a small misfit. A
//           blob has the grown centroid if its grown box costs at most its share of
//           limits.centroid_pixels_per_blob. A larger box uses what the others leave, in row order
//           from the top; without enough budget the centroid is the plain mean.
// Cost:     linear in runs and in the rescanned blocks; misfits and distances only when full
// (components x predictions);
//           linear in the grown boxes' pixels.
// Worst:    the maximum of single runs inside the gate, as many predictions as tools have markers,
//           and wide boxes among the kept blobs. A run is most expensive in rows of random dots,
//           because the branches are unpredictable.
// Accuracy: see centroid.hpp. Integers up to one division a coordinate.
// Source:   Puljiz et al., section III, detect blobs in the binary image; here in its runs.
#pragma once

#include <algorithm>
#include <span>

#include "kernels/image/blob.hpp"
#include "kernels/image/blob_scratch.hpp"
#include "kernels/image/blob_settings.hpp"
#include "kernels/image/frame.hpp"
#include "kernels/image/nearest_candidates.hpp"
#include "kernels/image/rescan.hpp"
#include "kernels/nonblocking.hpp"

namespace glint {

// Loop counts of one call.
struct BlobWork {
  std::int32_t runs = 0;
  std::int32_t distances = 0;  // of four components to a prediction or the focus
  std::int32_t blobs = 0;
  std::int32_t pixels = 0;   // of grown boxes, see GrownBox::pixels
  std::int32_t rescans = 0;  // blocks of components beyond the gate, see Rescan::blocks
};

// bands: the runs of this frame from top to bottom, at most k_row_bands. search: predictions beyond
// the number of the tools' markers are ignored. Sets out.reason to blobs_full if the blobs or their
// pixels exceed the budget, else to runs_full if a band or the rescan has it.
BlobWork find_blobs(const Frame& frame, std::span<const Runs* const> bands,
                    const BlobSettings& settings, const BlobSearch& search, BlobScratch& scratch,
                    Blobs& out, const Limits& limits = {}) noexcept GLINT_NONBLOCKING;

// Maximum number of runs, those of rescanned components included.
[[nodiscard]] constexpr int runs_of_all_bands_max(const Limits& limits) {
  const int band_rows = (limits.height + k_row_bands - 1) / k_row_bands;
  return k_row_bands * std::min(std::clamp(limits.runs_per_band, 0, k_runs_per_band_max),
                                band_rows * ((limits.width + 1) / 2));
}

// Maximum loop counts of find_blobs.
[[nodiscard]] constexpr BlobWork blob_work_max(const Limits& limits) {
  const int runs = runs_of_all_bands_max(limits);
  const int fours = (runs + 3) / 4;
  const int points = limits.tools * limits.markers_per_tool + 1;  // the predictions and the focus
  return {runs, fours * points, std::min(limits.blobs, runs),
          limits.blobs * limits.centroid_pixels_per_blob, rescan_blocks_max(limits)};
}

}  // namespace glint
