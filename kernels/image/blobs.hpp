// Runs to blobs: what may be a marker, where its middle is, and what else it was.
//
// What:     connected components inside the size gate, each with a sub-pixel centroid. More than
//           k_blobs_max: those nearest a predicted marker stay, then the topmost, then the
//           leftmost.
// Cost:     linear in runs; distances only when full (components x predictions); centroids of the
//           blobs kept.
// Worst:    16,384 single runs inside the gate and 128 predictions.
// Accuracy: see centroid.hpp. Integers up to one division a coordinate.
// Source:   the seed, section III, finds blobs in the binary picture; here from its runs.
#pragma once

#include <span>

#include "kernels/image/blob.hpp"
#include "kernels/image/blob_scratch.hpp"
#include "kernels/image/blob_settings.hpp"
#include "kernels/image/frame.hpp"

namespace glint {

inline constexpr int k_predictions_max = k_tools_max * k_markers_per_tool_max;

// bands: the runs of this frame from top to bottom, at most k_row_bands. predicted_px: where
// markers are expected, pixels; beyond k_predictions_max they are ignored. out.dropped counts what
// lies outside the gate or beyond the buffer; out.reason is blobs_full, else runs_full if a band's
// was.
void find_blobs(const Frame& frame, std::span<const Runs* const> bands,
                const BlobSettings& settings, std::span<const Vector2> predicted_px,
                BlobScratch& scratch, Blobs& out) noexcept;

}  // namespace glint
