// How badly a component fits a marker's disc: what find_blobs orders by where it cannot keep all.
//
// What:     steps for an area beside that of a whole marker at the component's depth (a step for
//           each factor of two), for a shape that is no disc's, and for little contrast.
// Cost:     at most five depths and one reflectivity are read; no floating point.
// Worst:    a saturated middle: its depth is missing, and four rim pixels are read.
// Accuracy: an order, not a decision: a marker that is half hidden or dim has one or two steps.
// Source:   a disc covers pi / 4 of its box; half the markers' least contrast is our own choice.
#pragma once

#include "kernels/image/blob_scratch.hpp"
#include "kernels/image/blob_settings.hpp"
#include "kernels/image/frame.hpp"
#include "kernels/nonblocking.hpp"

namespace glint {

inline constexpr int k_misfit_max = 4;

// 0: as a marker is, to k_misfit_max.
[[nodiscard]] int marker_misfit(const Frame& frame, const Component& component,
                                const BlobSettings& settings) noexcept GLINT_NONBLOCKING;

}  // namespace glint
