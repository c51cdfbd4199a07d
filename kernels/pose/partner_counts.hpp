// Number of partners of each candidate at the tool's distances, to prune the correspondence search
// by degree: a labeling of n markers gives each of its candidates n - 1 partners.
//
// What:     for each tool marker and each candidate, for how many other tool markers the candidate
//           has a partner.
// Cost:     (tool markers)^2 x words of a set, a few operations on words each.
// Worst:    data independent.
// Accuracy: exact; removing candidates with too few partners loses no labeling.
// Source:   counting in bit planes, as a carry-save adder does: Warren, "Hacker's Delight", 2nd
//           ed., section 5-1. Pruning by degree as in the search for cliques.
#pragma once

#include <array>
#include <cstdint>

#include "kernels/pose/pair_matches.hpp"

namespace glint {

class PartnerCounts {
 public:
  explicit PartnerCounts(const PairMatches& matches) noexcept {
    for (int i = 0; i < matches.markers; ++i) {
      for (int w = 0; w < matches.words; ++w) planes_[i][w] = planes_of(matches, i, w);
    }
  }

  // Returns the candidates in word w that, as marker i, have partners for at least `least` others.
  [[nodiscard]] std::uint64_t with_at_least(int least, int i, int w) const noexcept {
    std::uint64_t more = 0;
    std::uint64_t equal = ~std::uint64_t{0};
    for (int k = k_planes - 1; k >= 0; --k) {
      const std::uint64_t plane = planes_[i][w][k];
      const std::uint64_t bit = (least >> k & 1) != 0 ? ~std::uint64_t{0} : 0;
      more |= equal & plane & ~bit;
      equal &= ~(plane ^ bit);
    }
    return more | equal;
  }

 private:
  static constexpr int k_planes = 3;
  static_assert(k_markers_per_tool_max - 1 < 1 << k_planes);
  using Planes = std::array<std::uint64_t, k_planes>;  // bit a of plane k: bit k of a's count

  static Planes planes_of(const PairMatches& matches, int i, int w) {
    Planes planes{};
    for (int j = 0; j < matches.markers; ++j) {
      std::uint64_t carry = j == i ? 0 : matches.partnered[i][j].word[w];
      for (std::uint64_t& plane : planes) {
        const std::uint64_t sum = plane ^ carry;
        carry &= plane;
        plane = sum;
      }
    }
    return planes;
  }

  std::array<std::array<Planes, k_blobs_max / 64>, k_markers_per_tool_max> planes_;
};

}  // namespace glint
