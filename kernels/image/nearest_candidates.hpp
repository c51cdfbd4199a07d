// Selection of the k nearest blob candidates, if there are more than the budget.
//
// What:     keeps the candidates nearest to a predicted marker. If a tool may be anywhere, half of
//           the budget keeps those nearest to one candidate, the focus: the markers of a tool are
//           close together, so all of them stay if the focus is one of them. Each step of misfit
//           doubles the distance; among equals the first stay. The focus of turn k is candidate
//           floor(n frac(k phi)), phi the golden ratio: every candidate of a constant scene is the
//           focus once in 3 n turns, and one of its neighbours far earlier.
// Cost:     for every four candidates one distance to each prediction and to the focus, and for
//           each candidate one step for each bit of a distance; independent of the distances.
// Worst:    as many candidates as runs, as many predictions as tools have markers, and a search
//           everywhere.
// Accuracy: exact: squared distances in half pixels are integers below 2^23, and below 2^31 with
//           misfit. Distances from 2^23 on are equal: a prediction far outside the frame, or
//           opposite corners of the largest frame.
// Source:   order statistic without sorting: the largest distance with fewer than `budget` below
//           it, by bisection of its bits; Knuth, "The Art of Computer Programming", vol. 3, section
//           6.2.1. The golden ratio's gaps: the same, section 6.4, theorem S.
#pragma once

#include <cstdint>
#include <span>

#include "kernels/geometry.hpp"
#include "kernels/image/blob_scratch.hpp"
#include "kernels/nonblocking.hpp"

namespace glint {

inline constexpr int k_predictions_max = k_tools_max * k_markers_per_tool_max;

// Search targets. Predictions beyond k_predictions_max, or not finite or far (1e6 px) from the
// origin, are ignored.
struct BlobSearch {
  std::span<const Vector2> predicted_px{};  // markers of the tracked tools
  bool everywhere = false;                  // a tool may be anywhere; implied without predictions
  std::uint32_t turn = 0;                   // frame number: selects the focus
};

// The part of `budget` for candidates near one of `predictions` markers.
[[nodiscard]] constexpr int budget_near_predictions(const BlobSearch& search, int predictions,
                                                    int budget) {
  if (predictions == 0) return 0;
  if (!search.everywhere) return budget;
  const int half = budget / 2 > predictions ? budget / 2 : predictions;
  return half < budget ? half : budget;
}

// Keeps `budget` of the first `candidates` of scratch.candidate, in their order; reads and
// overwrites scratch.misfit. Returns the number of computed groups of four distances.
int select_nearest(const BlobSearch& search, BlobScratch& scratch, int candidates,
                   int budget) noexcept GLINT_NONBLOCKING;

}  // namespace glint
