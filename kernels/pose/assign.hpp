// Greedy assignment of labelings to tools: each marker belongs to at most one tool.
//
// What:     each round takes the best free labeling of all tools without one: more markers first,
//           then the smaller sum of squares minus the log prior ratio (log_prior_ratio_m2), then
//           the lower tool index. A labeling is free if no tool holds any of its markers. Of two
//           nearly equal tools the predicted one therefore keeps its markers, also while the other
//           is hidden and fits them too. A tool's rival is its alternative labeling: the next one
//           with as many markers, none of them held by another tool, and a different pose.
// Cost:     a test of k_markers_per_tool_max markers for each labeling tested. A taken labeling is
//           never tested again. Each round repeats only the test of each waiting tool's first free
//           labeling.
// Worst:    all but the last labeling of every tool contain the marker that is taken first.
// Accuracy: exact for the greedy order; the sum over all tools need not be optimal.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "kernels/nonblocking.hpp"
#include "kernels/pose/labeling.hpp"

namespace glint {

struct AssignWork {
  int rounds = 0;
  int tests = 0;  // labelings tested
};

// Upper bound on the tests of assign_markers() and alternative_of(). Tool r is served in round r,
// so it is tested once in each of r + 1 rounds. All tools but the first test up to k_labelings_max
// - 1 taken labelings more.
[[nodiscard]] constexpr int assign_tests_worst(int tools) {
  const int rivals = tools * (k_labelings_max - 1);
  return tools * (tools + 1) / 2 + (tools - 1) * (k_labelings_max - 1) + rivals;
}

// Each span has one element per tool, at most k_tools_max; the shortest span counts. Writes
// chosen[t]: the index into per_tool[t].items, or -1. Writes reasons[t]: none, the labelings' own
// reason if there are none, or markers_assigned_elsewhere.
AssignWork assign_markers(std::span<const Labelings> per_tool, std::span<int> chosen,
                          std::span<Reason> reasons) noexcept GLINT_NONBLOCKING;

// Index of the tool that holds each marker; -1: none.
using MarkerOwners = std::array<std::int8_t, k_blobs_max>;

// Returns the index of the tool's rival labeling, or -1. A predicted one (log_prior_ratio_m2 > 0)
// is preferred. Adds the labelings tested to `tests`, at most k_labelings_max - 1. tip_m: tool
// frame.
[[nodiscard]] int alternative_of(const Labelings& labelings, int chosen, int tool,
                                 const MarkerOwners& owners, const Vector3& tip_m,
                                 int& tests) noexcept GLINT_NONBLOCKING;

}  // namespace glint
