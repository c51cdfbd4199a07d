#include "kernels/image/nearest_candidates.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <memory>
#include <numeric>
#include <random>
#include <vector>

#include "kernels/image/marker_misfit.hpp"

namespace glint::nearest_candidates_test {
namespace {

struct Candidates {
  std::unique_ptr<BlobScratch> scratch = std::make_unique<BlobScratch>();
  std::vector<std::uint8_t> misfits;
  int count = 0;

  void add(int x, int y, int width = 1, int height = 1, int misfit = 0) {
    Component component;
    component.x0 = static_cast<std::uint16_t>(x);
    component.y0 = static_cast<std::uint16_t>(y);
    component.x1 = static_cast<std::uint16_t>(x + width);
    component.y1 = static_cast<std::uint16_t>(y + height);
    const auto at = static_cast<std::size_t>(count++);
    scratch->components[at] = component;
    scratch->candidate[at] = static_cast<std::uint16_t>(at);
    misfits.push_back(static_cast<std::uint8_t>(misfit));
  }

  std::vector<int> keep(const std::vector<Vector2>& predicted_px, int kept) {
    return keep(BlobSearch{predicted_px, false, 0}, kept);
  }
  std::vector<int> keep(const BlobSearch& search, int kept) {
    std::iota(scratch->candidate.begin(), scratch->candidate.begin() + count, std::uint16_t{0});
    std::copy(misfits.begin(), misfits.end(), scratch->misfit.begin());
    (void)select_nearest(search, *scratch, count, kept);
    return {scratch->candidate.begin(), scratch->candidate.begin() + kept};
  }

  [[nodiscard]] Vector2 centre(int i) const {
    const Component& c = scratch->components[static_cast<std::size_t>(i)];
    return {0.5 * (c.x0 + c.x1), 0.5 * (c.y0 + c.y1)};
  }

  // Reference: a stable sort by distance between box centre and prediction, in half pixels. Squared
  // distances saturate at 2^23 - 1. Each step of misfit doubles the distance; ties keep the index
  // order.
  [[nodiscard]] std::vector<int> sorted(const std::vector<Vector2>& predicted_px, int kept) const {
    std::vector<long> distance;
    for (int i = 0; i < count; ++i) {
      const Component& c = scratch->components[static_cast<std::size_t>(i)];
      long least = (1 << 23) - 1;
      for (const Vector2& p : predicted_px) {
        const long dx = c.x0 + c.x1 - static_cast<long>(2 * p.x());
        const long dy = c.y0 + c.y1 - static_cast<long>(2 * p.y());
        least = std::min(least, dx * dx + dy * dy);
      }
      for (int step = 0; step < misfits[static_cast<std::size_t>(i)]; ++step) least *= 4;
      distance.push_back(least);
    }
    std::vector<int> order(static_cast<std::size_t>(count));
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(), [&](int a, int b) {
      return distance[static_cast<std::size_t>(a)] < distance[static_cast<std::size_t>(b)];
    });
    order.resize(static_cast<std::size_t>(kept));
    std::sort(order.begin(), order.end());
    return order;
  }
};

TEST(NearestKept, AreThoseOfAPlainSort) {
  std::mt19937 random(5);
  const auto below = [&](int n) { return static_cast<int>(random() % static_cast<unsigned>(n)); };
  for (int round = 0; round < 300; ++round) {
    Candidates candidates;
    // A small field has many equal distances, a large one has distances that saturate.
    const int field = round % 3 == 0 ? 20 : round % 3 == 1 ? 500 : 1010;
    const int count = 2 + below(600);
    for (int i = 0; i < count; ++i) {
      const int x = below(field), y = below(field), misfit = round % 2 * below(5);
      candidates.add(x, y, 1 + below(12), 1 + below(12), misfit);
    }
    std::vector<Vector2> predicted;
    for (int i = below(k_predictions_max); i >= 0; --i) {
      predicted.push_back({below(2 * field) * 0.5 - 3, below(2 * field) * 0.5 - 3});
    }
    const int kept = 1 + below(count - 1);
    const std::vector<int> expected = candidates.sorted(predicted, kept);
    ASSERT_EQ(candidates.keep(predicted, kept), expected) << "round " << round;
  }
}

TEST(NearestKept, AreTheFirstOnesAmongEquals) {
  Candidates candidates;
  for (int i = 0; i < 9; ++i) candidates.add(100 + 10 * (i % 2), 50);
  EXPECT_EQ(candidates.keep({{105.5, 200}}, 4), (std::vector<int>{0, 1, 2, 3}));
  Candidates near_last;
  for (int i = 0; i < 9; ++i) near_last.add(i < 7 ? 10 : 300, 50);
  EXPECT_EQ(near_last.keep({{300, 50}}, 4), (std::vector<int>{0, 1, 7, 8}));
}

// Reference by full sorts: half of the budget by the predictions, the rest by the focus.
TEST(NearestKept, ShareTheBudgetBetweenPredictionsAndTheFocus) {
  std::mt19937 random(6);
  const auto below = [&](int n) { return static_cast<int>(random() % static_cast<unsigned>(n)); };
  for (int round = 0; round < 200; ++round) {
    Candidates candidates;
    const int count = 70 + below(300), kept = 64;
    for (int i = 0; i < count; ++i)
      candidates.add(below(500), below(500), 1 + below(12), 1 + below(12), below(5));
    std::vector<Vector2> predicted;
    for (int i = below(60); i >= 0; --i) predicted.push_back({below(500) + 0.0, below(500) + 0.0});
    const auto turn = static_cast<std::uint32_t>(random());
    const double part = static_cast<double>(turn * 2654435769u) / 4294967296.0;
    const int focus = static_cast<int>(part * count);

    const int share = std::max(kept / 2, static_cast<int>(predicted.size()));
    std::vector<int> expected = candidates.sorted(predicted, share);
    for (const int i : expected) ASSERT_LT(i, count);
    // The rest by the focus: candidates in order of distance that are not kept already.
    const std::vector<int> near = expected;
    for (int n = 1; static_cast<int>(expected.size()) < kept; ++n) {
      expected = near;
      for (const int i : candidates.sorted({candidates.centre(focus)}, n))
        if (!std::binary_search(near.begin(), near.end(), i)) expected.push_back(i);
    }
    std::sort(expected.begin(), expected.end());
    ASSERT_EQ(candidates.keep({predicted, true, turn}, kept), expected) << "round " << round;
  }
}

// Also without a prediction, for a tool that was never found.
TEST(NearestKept, HaveEveryCandidateInTheMiddleWithinTwiceAsManyTurns) {
  for (const int count : {65, 205, 1000, 1001}) {
    Candidates candidates;
    for (int i = 0; i < count; ++i) candidates.add(5 * (i % 100), 20 * (i / 100));
    std::vector<int> was_kept(static_cast<std::size_t>(count), 0);
    for (std::uint32_t turn = 7; turn < 7 + 2u * static_cast<unsigned>(count); ++turn) {
      // A budget of one keeps only the focus.
      ++was_kept[static_cast<std::size_t>(candidates.keep(BlobSearch{{}, false, turn}, 1).front())];
    }
    EXPECT_EQ(std::count(was_kept.begin(), was_kept.end(), 0), 0) << count;
  }
}

// One second of frames at 45 Hz, from any frame number.
TEST(NearestKept, HoldAllMarkersOfAToolInOneOf45Turns) {
  std::mt19937 random(7);
  const auto below = [&](int n) { return static_cast<int>(random() % static_cast<unsigned>(n)); };
  for (int round = 0; round < 100; ++round) {
    Candidates candidates;
    const int strays = round % 2 == 0 ? 200 : 500;
    std::vector<std::pair<int, int>> places;  // sorted by rows, as components are
    const int x = 40 + below(430), y = 40 + below(430);
    for (int i = 0; i < strays; ++i) places.emplace_back(below(512), below(512));
    for (int i = 0; i < 5; ++i) places.emplace_back(y + below(80) - 40, x + below(80) - 40);
    const std::vector<std::pair<int, int>> tool(places.end() - 5, places.end());
    std::sort(places.begin(), places.end());
    for (const auto& [row, column] : places) candidates.add(column, row);
    const auto first = static_cast<std::uint32_t>(random());
    bool together = false;
    for (std::uint32_t turn = 0; turn < 45 && !together; ++turn) {
      int held = 0;
      for (const int i : candidates.keep(BlobSearch{{}, false, first + turn}, 64))
        held += std::count(tool.begin(), tool.end(), places[static_cast<std::size_t>(i)]) > 0;
      together = held >= 5;
    }
    EXPECT_TRUE(together) << "round " << round;
  }
}

TEST(NearestKept, CountNonsenseAsNoPrediction) {
  Candidates candidates;
  for (int i = 0; i < 30; ++i) candidates.add(500 - 10 * i, i);
  const Vector2 nowhere(std::numeric_limits<double>::quiet_NaN(), 0);
  EXPECT_EQ(candidates.keep(BlobSearch{}, 3), (std::vector<int>{0, 1, 2})) << "turn 0";
  EXPECT_EQ(candidates.keep({nowhere, {1e300, 0}}, 3), (std::vector<int>{0, 1, 2}));
  EXPECT_EQ(select_nearest({}, *candidates.scratch, candidates.count, 3), (30 + 3) / 4);
}

// The corner opposite to a prediction outside the frame.
TEST(NearestKept, AreInOrderAtTheLargestDistance) {
  Candidates candidates;
  for (int i = 0; i < 6; ++i) candidates.add(511 - i, 511);
  EXPECT_EQ(candidates.keep({{-1e5, -1e5}}, 2), (std::vector<int>{4, 5}));
  Candidates wide;
  for (int i = 0; i < 6; ++i) wide.add(1023 - i, 1023, 1, 1, k_misfit_max);
  wide.add(1, 1, 1, 1, k_misfit_max);
  EXPECT_EQ(wide.keep({{1e5, 1e5}}, 6), (std::vector<int>{0, 1, 2, 3, 4, 5}));
  EXPECT_EQ(wide.keep({{-1e5, -1e5}}, 1), (std::vector<int>{6}));
}

TEST(NearestKept, LookAtNoMorePredictionsThanToolsHaveMarkers) {
  std::vector<Vector2> predicted(k_predictions_max, Vector2(20, 20));
  predicted.push_back({400, 400});
  Candidates candidates;
  for (int i = 0; i < 8; ++i) candidates.add(i < 4 ? 399 : 60, 399);
  EXPECT_EQ(candidates.keep(predicted, 4), (std::vector<int>{4, 5, 6, 7}));
  EXPECT_EQ(select_nearest({predicted, false, 0}, *candidates.scratch, 5, 4),
            2 * k_predictions_max);
  predicted.erase(predicted.begin());
  Candidates again;
  for (int i = 0; i < 8; ++i) again.add(i < 4 ? 399 : 60, 399);
  EXPECT_EQ(again.keep(predicted, 4), (std::vector<int>{0, 1, 2, 3}));
}

TEST(NearestKept, ShareOfThePredictionsIsHalfOrOneEachOrAll) {
  const auto share = [](bool everywhere, int predictions, int kept) {
    return budget_near_predictions({{}, everywhere, 0}, predictions, kept);
  };
  EXPECT_EQ(share(true, 0, 64), 0);
  EXPECT_EQ(share(false, 0, 64), 0) << "nothing is predicted";
  EXPECT_EQ(share(false, 1, 64), 64);
  EXPECT_EQ(share(true, 1, 64), 32);
  EXPECT_EQ(share(true, 31, 64), 32);
  EXPECT_EQ(share(true, 33, 64), 33);
  EXPECT_EQ(share(true, 70, 64), 64);
  EXPECT_EQ(share(true, 1, 9), 4);
}

TEST(NearestKept, CountFourDistancesToEachPredictionAndTheFocus) {
  for (const int count : {9, 12, 13}) {
    const int fours = (count + 3) / 4;
    const std::vector<Vector2> predicted(5, Vector2(20, 20));
    for (const bool everywhere : {false, true}) {
      Candidates candidates;
      for (int i = 0; i < count; ++i) candidates.add(10 * i, 5);
      candidates.keep({predicted, everywhere, 0}, 8);
      const BlobSearch search{predicted, everywhere, 0};
      EXPECT_EQ(select_nearest(search, *candidates.scratch, count, 8),
                fours * (everywhere ? 6 : 5));
      EXPECT_EQ(select_nearest(search, *candidates.scratch, count, 5), fours * 5)
          << "the predictions have the whole budget";
    }
  }
}

}  // namespace
}  // namespace glint::nearest_candidates_test
