#include "kernels/pose/partner_counts.hpp"

#include <gtest/gtest.h>

#include <memory>

#include "tests/unit/kernels/pose/scene.hpp"

namespace glint::partner_counts_test {
namespace {

bool has(const PairMatches& matches, int i, int a, int j, int b) {
  return (matches.word[static_cast<std::size_t>(matches.set_of(i, a, j) + b / 64)] >> (b % 64) &
          1) != 0;
}

// Reference: number of other markers at whose distance candidate a, as marker i, has a partner.
int partners_one_by_one(const PairMatches& matches, int i, int a) {
  int partners = 0;
  for (int j = 0; j < matches.markers; ++j) {
    if (j == i) continue;
    bool any = false;
    for (int b = 0; b < matches.candidates; ++b) {
      any = any || (i < j ? has(matches, i, a, j, b) : has(matches, j, b, i, a));
    }
    partners += any ? 1 : 0;
  }
  return partners;
}

TEST(PartnerCounts, AreThoseOfTheTableForEachMarkerAndCandidate) {
  test::Random random(17);
  auto scratch = std::make_unique<CorrespondScratch>();
  const CorrespondSettings settings;
  for (const int blobs : {3, 40, 64, 65, 150, k_blobs_max}) {
    const Tool tool = test::random_tool(random, 3 + blobs % 6);
    Markers markers;
    while (markers.count < blobs) {
      test::add_marker(markers, tool, Vector3(0, 0, 0.6) + random.in_box(0.9));
    }
    select_candidates(markers, tool, settings, nullptr, scratch->candidates);
    match_pairs(scratch->candidates, tool, settings, scratch->matches);
    const PairMatches& matches = scratch->matches;
    const PartnerCounts counts(matches);
    for (int i = 0; i < matches.markers; ++i) {
      for (int a = 0; a < matches.candidates; ++a) {
        const int partners = partners_one_by_one(matches, i, a);
        for (int least = 0; least < k_markers_per_tool_max; ++least) {
          const std::uint64_t enough = counts.with_at_least(least, i, a / 64) >> (a % 64) & 1;
          ASSERT_EQ(enough, partners >= least ? 1u : 0u)
              << blobs << " blobs, marker " << i << ", candidate " << a << ", least " << least;
        }
      }
    }
  }
}

}  // namespace
}  // namespace glint::partner_counts_test
