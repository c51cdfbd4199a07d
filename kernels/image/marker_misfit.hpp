// Misfit score of a component against a marker's disc, which ranks blobs if find_blobs cannot keep
// all.
//
// What:     sum of steps: for an area outside that of an isolated marker at the component's depth
//           (one step for each factor of two), for a shape unlike a disc, and for low contrast.
// Cost:     reads at most five depths and one reflectivity; no floating point.
// Worst:    a saturated centre: its depth is missing, and four rim pixels are read.
// Accuracy: a rank, not a decision: a marker that is half occluded or of low signal has one or two
//           steps.
// Source:   a disc covers pi / 4 of its box; half the markers' least contrast is our own choice.
#pragma once

#include "kernels/image/blob_scratch.hpp"
#include "kernels/image/blob_settings.hpp"
#include "kernels/image/frame.hpp"
#include "kernels/nonblocking.hpp"

namespace glint {

inline constexpr int k_misfit_max = 4;

// Returns 0 (fits a marker) to k_misfit_max.
[[nodiscard]] int marker_misfit(const Frame& frame, const Component& component,
                                const BlobSettings& settings) noexcept GLINT_NONBLOCKING;

}  // namespace glint
