// How surely this sensor tells the tools of a cell apart: by each tool's nearest wrong labeling.
//
// What:     of two tools, the way to take k markers of the one for k of the other that a rigid
//           motion explains best, k being what a tool is found by without a prediction; of one
//           tool, the best such exchange of all its own markers. No motion makes a mirror image.
//           The distance is the root of the least sum of squares over the noise of a marker.
// Cost:     markers are named one after the other; a partial naming whose sides alone differ by
//           more than the best one found is left: for m markers the squared differences of their
//           sides sum to at most m times the squares that any motion leaves. 16 tools of 8 markers
//           take 0.01 s, 0.1 s where nearly every pair uses its steps up (the unit test prints it).
// Worst:    tools of equal sides, grids: steps_max ends a pair, and its likeness says so.
// Accuracy: exact below limit_sigmas. The noise counts as large in all directions as along the ray,
//           for how a tool will be held is not known: held well it is told apart better. It is
//           the declared one, that of half a metre; further away tools are told apart less.
// Source:   least squares from singular values: Umeyama 1991, the lemma; its pruning: the squared
//           distances of m points from each other sum to m times those from their mean.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "kernels/pose/correspond_settings.hpp"
#include "kernels/pose/tool.hpp"

namespace glint {

// Here the wrong labeling fits better in one frame of a thousand: 2 * 3.09 sigmas.
inline constexpr double k_distinct_sigmas = 6.2;

struct DistinctionSettings {
  double sigma_m = CorrespondSettings{}.range_sigma_m;  // what the tracker counts on
  double limit_sigmas = k_distinct_sigmas;              // nothing beyond is looked for
  std::int64_t steps_max = 150'000;                     // for each two tools; a fit is k_fit_steps
};

// For each marker of the tool that is seen, the marker of the other one that it is taken for.
using TakenFor = std::array<int, k_markers_per_tool_max>;  // -1: for none

struct Likeness {
  int seen = 0, other = 0;  // tools of the set; the same one: its own markers exchanged
  TakenFor taken_for{};
  int markers = 0;  // taken for another; 0: none was found within the limit
  double distance_sigmas = 0;
  bool search_full = false;  // the steps ran out: there may be a nearer one
};

struct Distinction {
  std::vector<Likeness> likenesses;  // nearest first: those within the limit, or not all searched
  std::int64_t steps_most = 0;       // taken for one pair of tools
};

// The tools must be prepared. What holds for one of two tools seen as the other holds the other way
// round; where only one of them is found by three markers, that one is `other`.
[[nodiscard]] Distinction distinguish(const ToolSet& tools, const DistinctionSettings& settings);

// What the best rigid motion of the seen tool's markers onto those they are taken for leaves.
[[nodiscard]] double squares_left_m2(const Tool& seen, const Tool& other,
                                     const TakenFor& taken_for);

// How often noise makes the wrong one of two hypotheses fit better that lie so far apart, to first
// order: Phi(-d / 2), the likelihood ratio of two normal densities (Van Trees 1968, section 2.2).
[[nodiscard]] double wrong_share(double distance_sigmas);

}  // namespace glint
