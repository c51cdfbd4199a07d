// The markers that could belong to one tool, as points, and which pairs of them have the distance
// of which pair of the tool's markers: the table that the correspondence search walks.
//
// What:     d_R, the distance of two candidates, equals the tool's d_M if |d_R - d_M| < delta,
// where
//           delta follows from the noise of these two: a range error moves a marker along its ray,
//           so a pair beside each other keeps its distance, a pair behind each other does not.
// Cost:     candidates^2 / 2 distances of 3 ns, 20 ns more for each that is short enough.
// Worst:    256 candidates within a hand's breadth: 1 ms.
// Accuracy: exact to second order in the noise. With d the measured distance, e its direction, r
// the
//           rays, S the markers' covariances: true - measured = -e.(n_a - n_b) + |perpendicular|^2
//           / (2d), so delta = k s + k^2 p / (2d), s^2 = e'(S_a + S_b)e, p = trace(S_a + S_b) -
//           s^2.
// Source:   series of |d e - n| in n to second order.
#pragma once

#include <array>
#include <cstdint>

#include "kernels/pose/correspond.hpp"

namespace glint {

inline constexpr int k_tool_pairs_max = k_markers_per_tool_max * (k_markers_per_tool_max - 1) / 2;

// A set of candidates by index. Loops run over `words` of the set in use, not over all.
struct CandidateSet {
  std::array<std::uint64_t, k_blobs_max / 64> word;

  void insert(int i) { word[static_cast<unsigned>(i) / 64] |= bit(i); }
  void erase(int i) { word[static_cast<unsigned>(i) / 64] &= ~bit(i); }
  [[nodiscard]] static std::uint64_t bit(int i) {
    return std::uint64_t{1} << (static_cast<unsigned>(i) % 64);
  }
};

struct Candidates {
  std::array<Vector3, k_blobs_max> point_m;  // marker centres, camera frame
  std::array<Vector3, k_blobs_max> ray;
  std::array<double, k_blobs_max> across_variance_m2;  // of the centre, across its ray, an axis
  std::array<std::int16_t, k_blobs_max> marker;        // index into Markers
  int count = 0;
  int words = 0;  // of a CandidateSet that are in use
};

// 230 KB at most; only the part in use is touched.
struct PairMatches {
  std::array<std::array<CandidateSet, k_blobs_max>, k_tool_pairs_max> set;

  // The candidates that may be tool marker j when candidate a is tool marker i < j.
  [[nodiscard]] const CandidateSet& of(int i, int j, int a) const {
    return set[pair_index(i, j)][static_cast<std::size_t>(a)];
  }
  [[nodiscard]] static std::size_t pair_index(int i, int j) {
    return static_cast<std::size_t>(i * (2 * k_markers_per_tool_max - i - 1) / 2 + (j - i - 1));
  }
};

// Leaves out markers without depth, and those whose area cannot be the tool's marker at that range.
void select_candidates(const Markers& markers, const Tool& tool, const CorrespondSettings& settings,
                       Candidates& candidates) noexcept;

void match_pairs(const Candidates& candidates, const Tool& tool, const CorrespondSettings& settings,
                 PairMatches& matches) noexcept;

}  // namespace glint
