// Which candidates stay when there are more than the budget.
//
// What:     those whose box's middle is nearest to a predicted marker; among equals the first ones.
//           Without a prediction the first ones stay.
// Cost:     for each candidate one distance to every four predictions, and four times a step of the
//           selection; nothing that depends on the distances themselves.
// Worst:    as many candidates as runs, as many predictions as tools have markers.
// Accuracy: exact: half pixels, squared, are whole numbers below 2^23, which a float holds.
// Source:   selection by digits, most significant first: Knuth, "The Art of Computer Programming",
//           vol. 3, section 5.2.5, for one place of the order instead of all.
#pragma once

#include <span>

#include "kernels/geometry.hpp"
#include "kernels/image/blob_scratch.hpp"
#include "kernels/nonblocking.hpp"

namespace glint {

inline constexpr int k_predictions_max = k_tools_max * k_markers_per_tool_max;

// Keeps `kept` of scratch.candidate's first `candidates`, in their order. Predictions in pixels;
// beyond k_predictions_max, or not in reach of the frame, they are ignored. Gives the number of
// distances to four predictions that were computed.
int keep_nearest(std::span<const Vector2> predicted_px, BlobScratch& scratch, int candidates,
                 int kept) noexcept GLINT_NONBLOCKING;

}  // namespace glint
