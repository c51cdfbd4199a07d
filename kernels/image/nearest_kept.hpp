// Which candidates stay when there are more than the budget.
//
// What:     those nearest to a predicted marker; and, where a tool is searched for everywhere, in
//           half of the budget those nearest to one candidate, the focus: a tool's markers lie side
//           by side, so that all stay where the focus is one of them. Each step of misfit counts
//           as twice the distance; among equals the first ones stay. The focus of turn k is
//           candidate floor(n frac(k phi)), phi the golden ratio: every candidate of an unchanging
//           scene is the focus once in 3 n turns, and a neighbour of it is far earlier.
// Cost:     for every four candidates one distance to each prediction and to the focus, and for
//           each candidate a step for each bit of a distance; nothing depends on the distances.
// Worst:    as many candidates as runs, as many predictions as tools have markers, and a search.
// Accuracy: exact: half pixels, squared, are whole numbers below 2^23, and below 2^31 with misfit.
//           Distances from 2^23 on count alike: a prediction far outside the frame, or opposite
//           corners of the largest one.
// Source:   the place of an order without the order: the largest distance that fewer than `kept`
//           lie below, by bisection of its bits; Knuth, "The Art of Computer Programming", vol. 3,
//           section 6.2.1. The golden ratio's gaps: the same, section 6.4, theorem S.
#pragma once

#include <cstdint>
#include <span>

#include "kernels/geometry.hpp"
#include "kernels/image/blob_scratch.hpp"
#include "kernels/nonblocking.hpp"

namespace glint {

inline constexpr int k_predictions_max = k_tools_max * k_markers_per_tool_max;

// What is looked for. Predictions in pixels; beyond k_predictions_max, or not in reach of the
// frame, they are ignored.
struct BlobSearch {
  std::span<const Vector2> predicted_px{};  // markers of the tools that are tracked
  bool everywhere = false;                  // a tool may be anywhere; without predictions always
  std::uint32_t turn = 0;                   // number of the frame: where the focus is
};

// The part of `kept` that the nearest to `predictions` markers have.
[[nodiscard]] constexpr int kept_near_predictions(const BlobSearch& search, int predictions,
                                                  int kept) {
  if (predictions == 0) return 0;
  if (!search.everywhere) return kept;
  const int half = kept / 2 > predictions ? kept / 2 : predictions;
  return half < kept ? half : kept;
}

// Keeps `kept` of scratch.candidate's first `candidates`, in their order; reads and overwrites
// scratch.misfit. Returns the number of times that four distances were computed.
int keep_nearest(const BlobSearch& search, BlobScratch& scratch, int candidates,
                 int kept) noexcept GLINT_NONBLOCKING;

}  // namespace glint
