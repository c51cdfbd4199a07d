// Table of pair matches for the correspondence search: which pairs of candidates have the distance
// of which pair of the tool's markers.
//
// What:     d_R, the distance of two candidates, equals the tool's d_M if |d_R - d_M| < delta.
//           delta follows from the noise of these two: a range error moves a marker along its ray,
//           so it changes the distance of a pair one behind the other, but not of a pair side by
//           side.
// Cost:     candidates^2 / 2 pairs, each tested against each of the tool's distances, which is less
//           expensive than to look up those that might fit; and the writes of the table's words.
//           Independent of the candidates' positions.
// Worst:    the capacity of candidates; otherwise data independent.
// Accuracy: to second order in the noise. With d the measured distance, e its direction, r the
//           rays, S the markers' covariances: true - measured = -e.(n_a - n_b) + |perpendicular|^2
//           / (2d). The first term has the variance s^2 = e'(S_a + S_b)e. The second term has the
//           mean b = p / (2d), p = trace(S_a + S_b) - s^2, and at most the variance 2 b^2 (all of p
//           in one direction). So delta = k sqrt(s^2 + 2 b^2) + b.
// Source:   series of |d e - n| in n to second order; mean and variance of a squared normal value.
#pragma once

#include <array>
#include <cstdint>

#include "kernels/nonblocking.hpp"
#include "kernels/pose/candidates.hpp"

namespace glint {

inline constexpr int k_tool_pairs_max = k_markers_per_tool_max * (k_markers_per_tool_max - 1) / 2;

// If tool marker i is candidate a: the candidates that can then be tool marker j > i. A row stores
// the sets of all j contiguously, so that a search intersects all in one pass. The sets for j <= i
// are unused.
struct PairMatches {
  static constexpr std::size_t k_words_max = std::size_t{k_markers_per_tool_max} *
                                             k_markers_per_tool_max * k_blobs_max *
                                             (k_blobs_max / 64);
  std::array<std::uint64_t, k_words_max> word;
  // Of the pair (i, j) and of (j, i): the candidates that have a partner at its distance.
  std::array<CandidateSets, k_markers_per_tool_max> partnered;
  int candidates = 0, markers = 0, words = 0;  // in use; they define the rows' positions

  [[nodiscard]] int words_a_row() const { return markers * words; }
  // Index of the set for marker j if candidate a is marker i.
  [[nodiscard]] int set_of(int i, int a, int j) const {
    return (i * candidates + a) * words_a_row() + j * words;
  }
};

struct PairWork {
  int pairs = 0;
  int tests = 0;
  int words_written = 0;
};

PairWork match_pairs(const Candidates& candidates, const Tool& tool,
                     const CorrespondSettings& settings,
                     PairMatches& matches) noexcept GLINT_NONBLOCKING;

}  // namespace glint
