#include "kernels/pose/pair_matches.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "kernels/pose/correspond.hpp"
#include "tests/unit/kernels/pose/scene.hpp"

namespace glint::pair_matches_test {
namespace {

using test::Random;

bool has(const PairMatches& matches, int i, int a, int j, int b) {
  return (matches.word[static_cast<std::size_t>(matches.set_of(i, a, j) + b / 64)] >> (b % 64) &
          1) != 0;
}

bool is_partnered(const PairMatches& matches, int i, int j, int a) {
  const auto& set = matches.partnered[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)];
  return (set.word[static_cast<std::size_t>(a / 64)] >> (a % 64) & 1) != 0;
}

struct Gate {
  double distance_m = 0, delta_m = 0;
};

// Reference: the header's formula in double precision, with covariance matrices.
Gate gate_of(const Candidates& c, int a, int b, const CorrespondSettings& settings) {
  const auto covariance = [&](int at) {
    const auto i = static_cast<std::size_t>(at);
    const double across = c.across_variance_m2[i];
    const double along = settings.range_sigma_m * settings.range_sigma_m;
    return Matrix3(across * (Matrix3::Identity() - c.ray[i] * c.ray[i].transpose()) +
                   along * c.ray[i] * c.ray[i].transpose());
  };
  const Vector3 between =
      c.point_m[static_cast<std::size_t>(a)] - c.point_m[static_cast<std::size_t>(b)];
  const double d = between.norm();
  const Vector3 e = between / d;
  const Matrix3 both = covariance(a) + covariance(b);
  const double along = e.dot(both * e);
  const double bias = (both.trace() - along) / (2 * d);
  const double delta = settings.gate_sigmas * std::sqrt(along + 2 * bias * bias) + bias;
  return {d, std::max(delta, settings.delta_min_m)};
}

struct Table {
  std::unique_ptr<CorrespondScratch> scratch = std::make_unique<CorrespondScratch>();
  PairWork work;

  void fill(int count, const Tool& tool, const CorrespondSettings& settings, Random& random,
            double side_m) {
    auto markers = std::make_unique<Markers>();
    while (markers->count < count)
      test::add_marker(*markers, tool, Vector3(0, 0, 0.6) + random.in_box(side_m));
    select_candidates(*markers, tool, settings, nullptr, scratch->candidates);
    ASSERT_EQ(scratch->candidates.count, count);
    work = match_pairs(scratch->candidates, tool, settings, scratch->matches);
  }
};

// Pairs within rounding of the gate may match or not.
TEST(PairMatches, AreThoseOfThePlainFormula) {
  Random random(3);
  Table table;
  CorrespondSettings settings;
  settings.pixel_sigma_px = 0.8;
  settings.gate_sigmas = 5;
  int matched = 0, judged = 0;
  for (const int count : {2, 3, 4, 5, 31, 32, 33, 63, 64, 65, 97, 130}) {
    const Tool tool = test::random_tool(random, 3 + count % 6);
    settings.focal_px = count % 2 == 0 ? 0 : 150;
    settings.range_sigma_m = count % 3 == 0 ? 0.0003 : 0.004;
    settings.delta_min_m = count % 4 == 0 ? 0.012 : 0.001;
    table.fill(count, tool, settings, random, count < 10 ? 0.1 : 0.3);
    const PairMatches& matches = table.scratch->matches;
    for (int a = 0; a < count; ++a) {
      for (int b = 0; b < count; ++b) {
        for (int i = 0; i < tool.marker_count; ++i) {
          for (int j = i + 1; j < tool.marker_count; ++j) {
            if (a == b) {
              EXPECT_FALSE(has(matches, i, a, j, b)) << "itself";
              continue;
            }
            const Gate gate = gate_of(table.scratch->candidates, a, b, settings);
            const double off =
                std::abs(gate.distance_m -
                         tool.distance_m[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)]);
            if (std::abs(off - gate.delta_m) < 1e-6 + 1e-4 * gate.delta_m) continue;
            ASSERT_EQ(has(matches, i, a, j, b), off < gate.delta_m)
                << count << ": " << a << " as " << i << ", " << b << " as " << j;
            ++judged;
            matched += off < gate.delta_m ? 1 : 0;
          }
        }
      }
    }
  }
  EXPECT_GT(matched, judged / 50);
  EXPECT_LT(matched, judged / 2);
}

TEST(PairMatches, PartnerWhoHasAnotherAtThatDistanceEitherWay) {
  Random random(4);
  Table table;
  for (const int count : {3, 40, 70, 129}) {
    const Tool tool = test::random_tool(random, 4);
    table.fill(count, tool, {}, random, 0.4);
    const PairMatches& matches = table.scratch->matches;
    for (int i = 0; i < 4; ++i) {
      for (int j = i + 1; j < 4; ++j) {
        for (int a = 0; a < count; ++a) {
          bool any = false;
          for (int b = 0; b < count; ++b) {
            any = any || has(matches, i, a, j, b);
            EXPECT_EQ(has(matches, i, a, j, b), has(matches, i, b, j, a)) << "of either end";
          }
          EXPECT_EQ(is_partnered(matches, i, j, a), any);
          EXPECT_EQ(is_partnered(matches, j, i, a), any);
        }
        // Bits beyond the last candidate are zero.
        for (int a = 0; a < count; ++a)
          for (int b = count; b < 64 * matches.words; ++b)
            EXPECT_FALSE(has(matches, i, a, j, b)) << count << " " << b;
        for (int b = count; b < 64 * matches.words; ++b)
          EXPECT_FALSE(is_partnered(matches, i, j, b));
        ASSERT_FALSE(HasFailure()) << count;
      }
    }
  }
}

// Two blobs at the same position have no distance, for any gate.
TEST(PairMatches, HaveNoneOfTwoInOnePlace) {
  const Tool tool = test::tool_of<3>({{0, 0, 0}, {30, 0, 0}, {0, 40, 0}});
  CorrespondSettings settings;
  settings.range_sigma_m = 0.02;
  Markers markers;
  for (int i = 0; i < 3; ++i) test::add_marker(markers, tool, Vector3(0.1, 0, 0.5));
  auto scratch = std::make_unique<CorrespondScratch>();
  select_candidates(markers, tool, settings, nullptr, scratch->candidates);
  match_pairs(scratch->candidates, tool, settings, scratch->matches);
  for (int a = 0; a < 3; ++a)
    for (int b = 0; b < 3; ++b) EXPECT_FALSE(has(scratch->matches, 0, a, 1, b));
}

TEST(PairMatches, CountPairsTestsAndWords) {
  Random random(5);
  Table table;
  for (const int markers : {3, 5, 8}) {
    const Tool tool = test::random_tool(random, markers);
    const int tool_pairs = markers * (markers - 1) / 2;
    for (const int count : {1, 2, 7, 64, 65}) {
      table.fill(count, tool, {}, random, 0.4);
      EXPECT_EQ(table.work.pairs, count * (count - 1) / 2);
      EXPECT_EQ(table.work.tests, count * (count - 1) / 2 * tool_pairs);
      EXPECT_EQ(table.work.words_written, tool_pairs * count * (count > 64 ? 2 : 1));
      const PairMatches& matches = table.scratch->matches;
      EXPECT_EQ(matches.candidates, count);
      EXPECT_EQ(matches.markers, markers);
      EXPECT_EQ(matches.words, count > 64 ? 2 : 1);
      EXPECT_EQ(matches.words_a_row(), markers * matches.words);
    }
  }
}

}  // namespace
}  // namespace glint::pair_matches_test
