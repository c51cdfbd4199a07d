// Which tool gets which markers, when several tools claim the same ones.
//
// What:     in every round the best free labeling of all tools without one is taken: more markers
//           before fewer, then the smaller sum of squares less what a prediction that it agrees
//           with is worth, then the lower tool index. A labeling is free while none of its markers
//           is taken. So of two tools that are nearly equal the one that was there keeps its
//           markers, also while the other is hidden and fits them too. A tool's rival is its next
//           labeling of as many markers that no other tool has and that puts it elsewhere.
// Cost:     a test of k_markers_per_tool_max markers for each labeling looked at. A labeling found
//           taken is never looked at again: each round looks once more only at each waiting tool's
//           first one that was free.
// Worst:    all but the last labeling of every tool hold the marker that goes first.
// Accuracy: exact; it is greedy, so the sum over all tools need not be the best possible.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "kernels/nonblocking.hpp"
#include "kernels/pose/labeling.hpp"

namespace glint {

struct AssignWork {
  int rounds = 0;
  int tests = 0;  // labelings looked at
};

// Tool r is served in round r: it is looked at once in each of r + 1 rounds, and, but for the
// first, k_labelings_max - 1 times more for labelings that were taken.
[[nodiscard]] constexpr int assign_tests_worst(int tools) {
  const int rivals = tools * (k_labelings_max - 1);
  return tools * (tools + 1) / 2 + (tools - 1) * (k_labelings_max - 1) + rivals;
}

// All three spans have one element a tool (k_tools_max at most; the shortest counts). chosen[t]
// becomes the index into per_tool[t].items or -1; reasons[t] none, the labelings' own reason where
// there are none, or taken_by_other.
AssignWork assign_markers(std::span<const Labelings> per_tool, std::span<int> chosen,
                          std::span<Reason> reasons) noexcept GLINT_NONBLOCKING;

// Which tool each marker was given to, -1: none.
using MarkerOwners = std::array<std::int8_t, k_blobs_max>;

// Index of the tool's rival labeling, -1: there is none. One that the motion foretold comes first.
// `tests` grows by the labelings looked at, k_labelings_max - 1 at most.
[[nodiscard]] int rival_of(const Labelings& labelings, int chosen, int tool,
                           const MarkerOwners& owners, const Vector3& tip_m,
                           int& tests) noexcept GLINT_NONBLOCKING;

}  // namespace glint
