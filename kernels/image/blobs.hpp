// Runs to blobs: what may be a marker, where its middle is, and what else it was.
//
// What:     connected components inside the size gate, each with a sub-pixel centroid. If more than
//           limits.blobs are found, nearest_kept.hpp lists which stay: near predicted markers, near
//           a place that changes with the frame, and rather those that fit a marker. A blob whose
//           grown box holds no more than its share of limits.centroid_pixels_a_blob has the
//           centroid of that box, a larger one if the others leave enough, by rows from the top;
//           else the plain mean.
// Cost:     linear in runs; misfits and distances only when full (components x predictions);
//           linear in the grown boxes' pixels.
// Worst:    as many single runs inside the gate as fit, as many predictions as tools have markers,
//           and wide boxes among those that stay. A run is dearest where rows of dots lie at
//           random, as the processor cannot foresee which of them touch.
// Accuracy: see centroid.hpp. Integers up to one division a coordinate.
// Source:   the seed, section III, finds blobs in the binary picture; here from its runs.
#pragma once

#include <algorithm>
#include <span>

#include "kernels/image/blob.hpp"
#include "kernels/image/blob_scratch.hpp"
#include "kernels/image/blob_settings.hpp"
#include "kernels/image/frame.hpp"
#include "kernels/image/nearest_kept.hpp"
#include "kernels/nonblocking.hpp"

namespace glint {

// How often its loops ran.
struct BlobWork {
  std::int32_t runs = 0;
  std::int32_t distances = 0;  // of four components to a prediction or the focus
  std::int32_t blobs = 0;
  std::int32_t pixels = 0;  // of grown boxes, see GrownBox::pixels
};

// bands: the runs of this frame from top to bottom, at most k_row_bands. search: more predictions
// than tools have markers are ignored. out.reason is blobs_full where blobs or their pixels are
// beyond the budget, else runs_full if a band's was.
BlobWork find_blobs(const Frame& frame, std::span<const Runs* const> bands,
                    const BlobSettings& settings, const BlobSearch& search, BlobScratch& scratch,
                    Blobs& out, const Limits& limits = {}) noexcept GLINT_NONBLOCKING;

// What find_blobs may do at most.
[[nodiscard]] constexpr BlobWork blob_work_max(const Limits& limits) {
  const int band_rows = (limits.height + k_row_bands - 1) / k_row_bands;
  const int runs =
      k_row_bands * std::min(limits.runs_per_band, band_rows * ((limits.width + 1) / 2));
  const int fours = (runs + 3) / 4;
  const int points = limits.tools * limits.markers_per_tool + 1;  // the predictions and the focus
  return {runs, fours * points, std::min(limits.blobs, runs),
          limits.blobs * limits.centroid_pixels_a_blob};
}

}  // namespace glint
