// Which candidates stay when there are more than the budget.
//
// What:     those whose box's middle is nearest to a predicted marker; among equals the first ones.
//           Without a prediction the first ones stay.
// Cost:     for every four candidates one distance to each prediction, and for each candidate a
//           step for each bit of a distance; nothing that depends on the distances themselves.
// Worst:    as many candidates as runs, as many predictions as tools have markers.
// Accuracy: exact: half pixels, squared, are whole numbers below 2^23.
// Source:   the place of an order without the order: the largest distance that fewer than `kept`
//           lie below, by bisection of its bits; Knuth, "The Art of Computer Programming", vol. 3,
//           section 6.2.1.
#pragma once

#include <span>

#include "kernels/geometry.hpp"
#include "kernels/image/blob_scratch.hpp"
#include "kernels/nonblocking.hpp"

namespace glint {

inline constexpr int k_predictions_max = k_tools_max * k_markers_per_tool_max;

// Keeps `kept` of scratch.candidate's first `candidates`, in their order. Predictions in pixels;
// beyond k_predictions_max, or not in reach of the frame, they are ignored. Gives the number of
// times that four distances were computed.
int keep_nearest(std::span<const Vector2> predicted_px, BlobScratch& scratch, int candidates,
                 int kept) noexcept GLINT_NONBLOCKING;

}  // namespace glint
