#include "kernels/image/nearest_kept.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <memory>
#include <numeric>
#include <random>
#include <vector>

namespace glint {
namespace {

struct Candidates {
  std::unique_ptr<BlobScratch> scratch = std::make_unique<BlobScratch>();
  int count = 0;

  void add(int x, int y, int width = 1, int height = 1) {
    Component component;
    component.x0 = static_cast<std::uint16_t>(x);
    component.y0 = static_cast<std::uint16_t>(y);
    component.x1 = static_cast<std::uint16_t>(x + width);
    component.y1 = static_cast<std::uint16_t>(y + height);
    const auto at = static_cast<std::size_t>(count++);
    scratch->components[at] = component;
    scratch->candidate[at] = static_cast<std::uint16_t>(at);
  }

  std::vector<int> keep(const std::vector<Vector2>& predicted_px, int kept) {
    (void)keep_nearest(predicted_px, *scratch, count, kept);
    return {scratch->candidate.begin(), scratch->candidate.begin() + kept};
  }

  // A plain sort by the distance of the box's middle in whole half pixels, then by place.
  [[nodiscard]] std::vector<int> sorted(const std::vector<Vector2>& predicted_px, int kept) const {
    std::vector<long> distance;
    for (int i = 0; i < count; ++i) {
      const Component& c = scratch->components[static_cast<std::size_t>(i)];
      long least = std::numeric_limits<long>::max();
      for (const Vector2& p : predicted_px) {
        const long dx = c.x0 + c.x1 - static_cast<long>(2 * p.x());
        const long dy = c.y0 + c.y1 - static_cast<long>(2 * p.y());
        least = std::min(least, dx * dx + dy * dy);
      }
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
    const int field = round % 3 == 0 ? 20 : 500;  // a small one has many equal distances
    const int count = 2 + below(600);
    for (int i = 0; i < count; ++i) {
      candidates.add(below(field), below(field), 1 + below(12), 1 + below(12));
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

TEST(NearestKept, AreTheFirstOnesWithoutAPrediction) {
  Candidates candidates;
  for (int i = 0; i < 30; ++i) candidates.add(500 - 10 * i, i);
  EXPECT_EQ(candidates.keep({}, 3), (std::vector<int>{0, 1, 2}));
  const Vector2 nowhere(std::numeric_limits<double>::quiet_NaN(), 0);
  EXPECT_EQ(candidates.keep({nowhere, {1e300, 0}}, 3), (std::vector<int>{0, 1, 2}));
  const std::vector<Vector2> none{nowhere};
  EXPECT_EQ(keep_nearest(none, *candidates.scratch, candidates.count, 3), 0);
}

// At the corner opposite to a prediction that lies outside the frame.
TEST(NearestKept, AreInOrderAtTheLargestDistance) {
  Candidates candidates;
  for (int i = 0; i < 6; ++i) candidates.add(511 - i, 511);
  EXPECT_EQ(candidates.keep({{-1e5, -1e5}}, 2), (std::vector<int>{4, 5}));
}

TEST(NearestKept, LookAtNoMorePredictionsThanToolsHaveMarkers) {
  std::vector<Vector2> predicted(k_predictions_max, Vector2(20, 20));
  predicted.push_back({400, 400});
  Candidates candidates;
  for (int i = 0; i < 8; ++i) candidates.add(i < 4 ? 399 : 60, 399);
  EXPECT_EQ(candidates.keep(predicted, 4), (std::vector<int>{4, 5, 6, 7}));
  EXPECT_EQ(keep_nearest(predicted, *candidates.scratch, 5, 4), 2 * k_predictions_max);
  predicted.erase(predicted.begin());
  Candidates again;
  for (int i = 0; i < 8; ++i) again.add(i < 4 ? 399 : 60, 399);
  EXPECT_EQ(again.keep(predicted, 4), (std::vector<int>{0, 1, 2, 3}));
}

}  // namespace
}  // namespace glint
