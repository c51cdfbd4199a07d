// Which pairs of candidates have the distance of which pair of the tool's markers: the table that
// the correspondence search walks.
//
// What:     d_R, the distance of two candidates, equals the tool's d_M if |d_R - d_M| < delta.
//           Delta follows from the noise of these two: a range error moves a marker along its ray,
//           so a pair beside each other keeps its distance, a pair behind each other does not.
// Cost:     candidates^2 / 2 pairs, each tested against each of the tool's distances, which is
//           cheaper than to look up which of them might fit; and the words of the table are
//           written. The same wherever the candidates are.
// Worst:    all candidates there may be; none are worse than others.
// Accuracy: to second order in the noise. With d the measured distance, e its direction, r the
//           rays, S the markers' covariances: true - measured = -e.(n_a - n_b) + |perpendicular|^2
//           / (2d), whose first part has the variance s^2 = e'(S_a + S_b)e and whose second one
//           the mean b = p / (2d), p = trace(S_a + S_b) - s^2, and at most the variance 2 b^2 (all
//           of p in one direction). So delta = k sqrt(s^2 + 2 b^2) + b.
// Source:   series of |d e - n| in n to second order; mean and variance of a squared normal value.
#pragma once

#include <array>
#include <cstdint>

#include "kernels/nonblocking.hpp"
#include "kernels/pose/candidates.hpp"

namespace glint {

inline constexpr int k_tool_pairs_max = k_markers_per_tool_max * (k_markers_per_tool_max - 1) / 2;

// For tool marker i being candidate a: the candidates that may then be tool marker j > i. A row
// holds the sets of all j side by side, so that a search narrows all in one go; those for j <= i
// are unused and hold nothing.
struct PairMatches {
  static constexpr std::size_t k_words_max = std::size_t{k_markers_per_tool_max} *
                                             k_markers_per_tool_max * k_blobs_max *
                                             (k_blobs_max / 64);
  std::array<std::uint64_t, k_words_max> word;
  // Of the pair (i, j) and of (j, i): the candidates that have another at its distance.
  std::array<CandidateSets, k_markers_per_tool_max> partnered;
  int candidates = 0, markers = 0, words = 0;  // in use, and so the rows' places

  [[nodiscard]] int words_a_row() const { return markers * words; }
  // Where the set for marker j stands when candidate a is marker i.
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
