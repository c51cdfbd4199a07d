// Distinction of the tools of a cell: distance to each tool's nearest wrong labeling.
//
// What:     for two tools, finds the assignment of k markers of one to k of the other with the
//           smallest least-squares residual of a rigid motion; k is the number of markers that find
//           a tool without a prediction. For one tool, finds the best exchange of all its own
//           markers. Mirror images are excluded. The distance is the root of the residual sum of
//           squares over the standard deviation of a marker.
// Cost:     depth-first search, marker by marker, with branch and bound: prunes a partial
//           assignment whose side lengths alone exceed the best residual. For m markers the sum of
//           squared side differences is at most m times the residual of any motion. 16 tools of 8
//           markers take 0.01 s; 0.1 s if nearly every pair exhausts its steps (the unit test
//           prints it).
// Worst:    tools of equal sides, grids: steps_max ends the search of a pair and sets
// steps_exhausted. Accuracy: exact below limit_sigmas. The noise is isotropic with the standard
// deviation along the
//           ray, since the tool's orientation is unknown; a favourable orientation increases the
//           distance. It is the declared noise at 0.5 m; at a larger range distances are smaller.
// Source:   least squares from singular values: Umeyama 1991, the lemma. Pruning: the squared
//           distances of m points from each other sum to m times those from their mean.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "kernels/pose/correspond_settings.hpp"
#include "kernels/pose/tool.hpp"

namespace glint {

// At this distance the wrong labeling fits better in one frame of 1000: 2 * 3.09 sigma.
inline constexpr double k_distinct_sigmas = 6.2;

struct DistinctionSettings {
  double sigma_m = CorrespondSettings{}.range_sigma_m;  // as the tracker
  double limit_sigmas = k_distinct_sigmas;              // the search ignores larger distances
  std::int64_t steps_max = 150'000;  // per pair of tools; a fit counts k_fit_steps
};

// For each marker of the seen tool, the assigned marker of the other one.
using MarkerAssignment = std::array<int, k_markers_per_tool_max>;  // -1: none

struct WrongLabeling {
  int seen = 0, other = 0;  // indices of tools; equal: own markers exchanged
  MarkerAssignment assignment{};
  int markers = 0;  // assigned; 0: none was found within the limit
  double distance_sigmas = 0;
  bool steps_exhausted = false;  // steps exhausted: a nearer one may exist
};

struct Distinction {
  std::vector<WrongLabeling>
      wrong_labelings;              // nearest first: within the limit, or steps_exhausted
  std::int64_t steps_max_used = 0;  // maximum over the pairs of tools
};

// Requires prepared tools. The result is symmetric in seen and other. If the tools need different
// numbers of markers, the one that needs fewer is `other`.
[[nodiscard]] Distinction distinguish(const ToolSet& tools, const DistinctionSettings& settings);

// Returns the residual sum of squares of the best rigid motion of the seen tool's markers onto the
// assigned ones.
[[nodiscard]] double residual_squares_m2(const Tool& seen, const Tool& other,
                                         const MarkerAssignment& assignment);

// Returns the probability that noise makes the wrong one of two hypotheses at this distance fit
// better, to first order: Phi(-d / 2), likelihood ratio of two normal densities (Van Trees 1968,
// section 2.2).
[[nodiscard]] double error_probability(double distance_sigmas);

}  // namespace glint
