#include "kernels/image/blobs.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <numeric>

#include "kernels/image/roi_threshold.hpp"
#include "tests/unit/kernels/image/test_image.hpp"

namespace glint::blobs_test {
namespace {

using test::image_of;
using test::TestImage;

struct Finder {
  std::unique_ptr<Runs> upper = std::make_unique<Runs>(), lower = std::make_unique<Runs>();
  std::unique_ptr<BlobScratch> scratch = std::make_unique<BlobScratch>();
  std::unique_ptr<Blobs> blobs = std::make_unique<Blobs>();
  BlobSettings settings{1, 100000, 500, 0xFFFF};
  std::vector<Vector2> predicted;
  int bands = 1;
  std::uint32_t turn = 0;
  Limits limits;

  const Blobs& operator()(const TestImage& picture) {
    const Frame frame = picture.frame();
    const Rois all = whole_frame(frame);
    threshold_runs(frame, all, settings.threshold, {0, bands}, *upper);
    if (bands == 2) threshold_runs(frame, all, settings.threshold, {1, 2}, *lower);
    const Runs* both[] = {upper.get(), lower.get()};
    find_blobs(frame, {both, static_cast<std::size_t>(bands)}, settings, {predicted, false, turn},
               *scratch, *blobs, limits);
    return *blobs;
  }
};

TEST(Blobs, JoinsPixelsThatTouchByACorner) {
  Finder find;
  EXPECT_EQ(find(image_of({"#..", ".#.", "..#"})).count, 1);
  EXPECT_EQ(find(image_of({"..#", ".#.", "#.."})).count, 1);
  EXPECT_EQ(find(image_of({"#.#", "...", "#.#"})).count, 4);
}

TEST(Blobs, JoinsTheTwoLegsOfAU) {
  Finder find;
  const Blobs& blobs = find(image_of({"#...#.#", "#...#.#", "#####.#"}));
  ASSERT_EQ(blobs.count, 2);
  EXPECT_EQ(blobs.items[0].area_px, 9u);
  EXPECT_EQ(blobs.items[0].x0, 0);
  EXPECT_EQ(blobs.items[0].x1, 5);
  EXPECT_EQ(blobs.items[0].y1, 3);
  EXPECT_EQ(blobs.items[1].area_px, 3u);
}

TEST(Blobs, AreTheSameInOneBandAndInTwo) {
  TestImage p(100, 60);
  test::add_disc(p, 30.3, 29.8, 5, 9000);  // across the band border at row 30
  test::add_disc(p, 70.1, 12.4, 3, 9000);
  test::add_disc(p, 60.1, 50.4, 3, 9000);
  Finder one, two;
  two.bands = 2;
  const Blobs& a = one(p);
  const Blobs& b = two(p);
  ASSERT_EQ(a.count, 3);
  ASSERT_EQ(b.count, 3);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(a.items[i].centroid_px, b.items[i].centroid_px);
    EXPECT_EQ(a.items[i].area_px, b.items[i].area_px);
  }
}

// Flood fill: a reference that does not use runs.
std::vector<int> areas_by_flood(TestImage p) {
  std::vector<int> areas;
  for (int y = 0; y < p.height; ++y) {
    for (int x = 0; x < p.width; ++x) {
      if (p(x, y) <= 500) continue;
      std::vector<std::array<int, 2>> open{{x, y}};
      p(x, y) = 0;
      int area = 0;
      while (!open.empty()) {
        const auto [cx, cy] = open.back();
        open.pop_back();
        ++area;
        for (int i = 0; i < 9; ++i) {
          const int nx = cx + i % 3 - 1, ny = cy + i / 3 - 1;
          if (nx < 0 || ny < 0 || nx >= p.width || ny >= p.height || p(nx, ny) <= 500) continue;
          p(nx, ny) = 0;
          open.push_back({nx, ny});
        }
      }
      areas.push_back(area);
    }
  }
  std::sort(areas.begin(), areas.end());
  return areas;
}

TEST(Blobs, AreThoseOfAFloodFillOnRandomFrames) {
  std::mt19937 random(3);
  Finder find;
  find.bands = 2;
  for (int round = 0; round < 300; ++round) {
    TestImage p(static_cast<int>(1 + random() % 40), static_cast<int>(2 + random() % 30));
    const unsigned density = 1 + random() % 9;
    for (auto& value : p.pixels_16) value = random() % 10 < density ? 1000 : 0;
    const Blobs& blobs = find(p);
    std::vector<int> areas;
    for (int i = 0; i < blobs.count; ++i) {
      areas.push_back(static_cast<int>(blobs.items[static_cast<std::size_t>(i)].area_px));
    }
    std::sort(areas.begin(), areas.end());
    ASSERT_EQ(areas, areas_by_flood(p)) << "round " << round;
  }
}

TEST(Blobs, DropsAndCountsWhatIsOutsideTheSizeGate) {
  Finder find;
  find.settings.min_area_px = 2;
  find.settings.max_area_px = 3;
  const Blobs& blobs = find(image_of({"#.##.####", ".........", "###......"}));
  ASSERT_EQ(blobs.count, 2);
  EXPECT_EQ(blobs.items[0].area_px, 2u);
  EXPECT_EQ(blobs.items[1].area_px, 3u);
  EXPECT_EQ(blobs.dropped, 2u);
  EXPECT_EQ(blobs.reason, Reason::none);
}

// Returns an image of 400 isolated pixels in a grid, 20 a row.
TestImage dots() {
  TestImage p(80, 80);
  for (int i = 0; i < 400; ++i) p(i % 20 * 4 + 1, i / 20 * 4 + 1) = 1000;
  return p;
}

TEST(Blobs, SaysHowManyWereLeftOutWhenFull) {
  Finder find;
  const Blobs& blobs = find(dots());
  ASSERT_EQ(blobs.count, k_blobs_max);
  EXPECT_EQ(blobs.dropped, 400u - k_blobs_max);
  EXPECT_EQ(blobs.left_out, 400u - k_blobs_max);
  EXPECT_EQ(blobs.reason, Reason::blobs_full);
  EXPECT_EQ(blobs.incomplete, Reason::blobs_full);
}

TEST(Blobs, KeepsOthersInAnotherFrameWhenFullAndNothingIsPredicted) {
  Finder find;
  std::vector<int> was_kept(400, 0);
  for (find.turn = 0; find.turn < 20; ++find.turn) {
    const Blobs& blobs = find(dots());
    for (const Blob& blob : blobs.items) {
      const auto dot = static_cast<std::size_t>(blob.x0 / 4 + 20 * (blob.y0 / 4));
      ++was_kept[dot];
    }
  }
  EXPECT_EQ(std::count(was_kept.begin(), was_kept.end(), 0), 0);
}

// Five markers and 1000 single pixels, as of a bad sensor; single pixels do not fit a marker's
// size.
TEST(Blobs, KeepsMarkersAmongAThousandSinglePixels) {
  std::mt19937 random(4);
  TestImage p(512, 512);
  for (int i = 0; i < 1000; ++i)
    p(static_cast<int>(random() % 512), static_cast<int>(random() % 512)) = 9000;
  for (int i = 0; i < 5; ++i) test::add_disc(p, 400.3 + 15 * i, 430.6 - 7 * (i % 2), 3, 9000);
  Finder find;
  find.settings.sizes = marker_sizes({0.0055, 0.0055, 0.8, 253, 0.15, 1.0, 0.001, 4090});
  int isolated = 0;
  for (find.turn = 0; find.turn < 40; ++find.turn) {
    const Blobs& blobs = find(p);
    int markers = 0;
    for (const Blob& blob : blobs.items) markers += blob.area_px > 20 ? 1 : 0;
    isolated += markers == 5 ? 1 : 0;
  }
  EXPECT_GE(isolated, 20);
}

TEST(Blobs, KeepsTheBlobsNearestAPredictionWhenFull) {
  Finder find;
  find.predicted = {{77.5, 77.5}, {NAN, 0}, {1e300, -1e300}};  // the last dot; then invalid
  const Blobs& blobs = find(dots());
  ASSERT_EQ(blobs.count, k_blobs_max);
  EXPECT_EQ(blobs.items[k_blobs_max - 1].x0, 77);
  EXPECT_EQ(blobs.items[k_blobs_max - 1].y0, 77);
  EXPECT_GT(blobs.items[0].x0 + blobs.items[0].y0, 8);  // dots in the far corner are discarded
  const auto distance = [](const Blob& b) { return std::hypot(b.x0 - 77.0, b.y0 - 77.0); };
  double farthest = 0;
  for (const Blob& blob : blobs.items) farthest = std::max(farthest, distance(blob));
  int nearer = 0;
  for (int i = 0; i < 400; ++i) {
    nearer += std::hypot(i % 20 * 4 + 1 - 77.0, i / 20 * 4 + 1 - 77.0) < farthest;
  }
  EXPECT_LE(nearer, k_blobs_max);
}

TEST(Blobs, KeepsTheSizeGateBeforeAnyPrediction) {
  TestImage p = dots();
  for (int y = 40; y < 80; ++y) {
    for (int x = 0; x < 80; ++x) p(x, y) = 1000;  // a hand at the predicted marker
  }
  Finder find;
  find.settings.max_area_px = 20;
  find.predicted = {{60, 60}};
  const Blobs& blobs = find(p);
  EXPECT_EQ(blobs.count, 200);
  EXPECT_EQ(blobs.dropped, 1u);
}

TEST(Blobs, SurvivesACheckerboardAndPassesOnThatRunsWereLost) {
  TestImage p(512, 512);
  for (int y = 0; y < 512; ++y) {
    for (int x = y % 2; x < 512; x += 2) p(x, y) = 5000;
  }
  Finder find;
  find.bands = 2;
  const Blobs& blobs = find(p);
  EXPECT_EQ(blobs.count, 2);  // one a band: its first 16 rows are connected
  EXPECT_EQ(blobs.reason, Reason::runs_full);
}

TEST(Blobs, FlagsTheBorderAndSaturation) {
  TestImage p(12, 3);
  p(0, 1) = 1000;
  p(5, 1) = 4000;
  p(11, 2) = 1000;
  Finder find;
  find.settings.saturated_from = 4000;
  const Blobs& blobs = find(p);
  ASSERT_EQ(blobs.count, 3);
  EXPECT_EQ(blobs.items[0].flags, k_blob_touches_edge);
  EXPECT_EQ(blobs.items[1].flags, k_blob_saturated);
  EXPECT_EQ(blobs.items[1].peak, 4000);
  EXPECT_EQ(blobs.items[2].flags, k_blob_touches_edge);
}

// Flags, and variance along the axis that the border cuts, at each of the four borders.
TEST(Blobs, TouchEachOfTheFourBordersOnlyInItsOutermostPixel) {
  constexpr int k_width = 21, k_height = 15, k_side = 3;
  const auto blob_at = [&](int x0, int y0) {
    TestImage p(k_width, k_height);
    for (int i = 0; i < k_side * k_side; ++i) p(x0 + i % k_side, y0 + i / k_side) = 9000;
    Finder find;
    const Blobs& blobs = find(p);
    EXPECT_EQ(blobs.count, 1);
    return blobs.items[0];
  };
  constexpr int k_last_x = k_width - k_side, k_last_y = k_height - k_side;
  const Blob inside = blob_at(8, 6);
  EXPECT_EQ(inside.flags, 0);
  for (const auto& [x, y] : {std::pair{1, 6}, {k_last_x - 1, 6}, {8, 1}, {8, k_last_y - 1}}) {
    EXPECT_EQ(blob_at(x, y).flags, 0) << x << ' ' << y;
  }
  for (const auto& [x, y] : {std::pair{0, 6}, {k_last_x, 6}, {8, 0}, {8, k_last_y}}) {
    const Blob cut = blob_at(x, y);
    EXPECT_EQ(cut.flags, k_blob_touches_edge) << x << ' ' << y;
    const std::size_t across = y == 6 ? 0 : 1;
    EXPECT_GT(cut.variance_px2[across], 3 * inside.variance_px2[across]) << x << ' ' << y;
    EXPECT_GT(cut.variance_px2[across], 3 * cut.variance_px2[1 - across]) << x << ' ' << y;
  }
}

TEST(Blobs, ComeByRowsThenFromLeft) {
  Finder find;
  // Blobs are in the order of their boxes' (y0, x0).
  const Blobs& blobs = find(image_of({"...#.#", "#..#..", "##..#."}));
  for (int i = 1; i < blobs.count; ++i) {
    const Blob& a = blobs.items[static_cast<std::size_t>(i - 1)];
    const Blob& b = blobs.items[static_cast<std::size_t>(i)];
    EXPECT_LE(std::pair(a.y0, a.x0), std::pair(b.y0, b.x0));
  }
  EXPECT_EQ(find(TestImage(8, 8)).count, 0);
}

// The second component begins further right in its first row, but its box begins further left.
TEST(Blobs, ComeByTheirBoxesCornersNotByTheirFirstRuns) {
  Finder find;
  const Blobs& blobs = find(image_of({"..#..#", ".....#", "#####.", "......", "#....."}));
  ASSERT_EQ(blobs.count, 3);
  EXPECT_EQ(blobs.items[0].area_px, 7u);
  EXPECT_EQ(blobs.items[0].x0, 0);
  EXPECT_EQ(blobs.items[1].area_px, 1u);
  EXPECT_EQ(blobs.items[1].x0, 2);
  EXPECT_EQ(blobs.items[2].y0, 4);
}

// Largest frame: its corners, and pixels beside and below its centre.
TEST(Blobs, ComeByRowsThenFromLeftInTheLargestFrame) {
  Finder find;
  find.bands = 2;
  TestImage wide(k_width_max, k_height_max);
  const std::vector<std::pair<int, int>> pixels = {// row, column
                                                   {0, 0},     {0, 511},  {0, 513},    {0, 1023},
                                                   {1, 100},   {511, 3},  {513, 1},    {513, 1020},
                                                   {514, 100}, {1023, 0}, {1023, 1023}};
  for (const auto& [y, x] : pixels) wide(x, y) = 1000;
  const Blobs& blobs = find(wide);
  ASSERT_EQ(blobs.count, static_cast<int>(pixels.size()));
  for (int i = 0; i < blobs.count; ++i) {
    const auto at = static_cast<std::size_t>(i);
    EXPECT_EQ(blobs.items[at].y0, pixels[at].first);
    EXPECT_EQ(blobs.items[at].x0, pixels[at].second);
    EXPECT_EQ(blobs.items[at].centroid_px,
              Vector2(pixels[at].second + 0.5, pixels[at].first + 0.5));
  }
}

TEST(Blobs, SayThatAnotherLiesTwoPixelsBesideThem) {
  for (const int gap : {1, 2, 3}) {
    TestImage p(60, 40);
    for (int y = 10; y < 16; ++y) {
      for (int x = 10; x < 16; ++x) p(x, y) = p(x + 6 + gap, y) = 9000;
    }
    Finder find;
    const Blobs& blobs = find(p);
    ASSERT_EQ(blobs.count, 2);
    for (const int i : {0, 1}) {
      const Blob& blob = blobs.items[static_cast<std::size_t>(i)];
      EXPECT_EQ((blob.flags & k_blob_has_neighbour) != 0, gap == 1) << gap;
    }
  }
}

TEST(Blobs, HaveALargerVarianceWhereTheyAreCutOrMerged) {
  TestImage p(90, 40);
  test::add_disc(p, 20.3, 20.6, 3, 9000);
  test::add_disc(p, 50.3, 20.6, 3, 9000);
  test::add_disc(p, 56.3, 20.6, 3, 9000);
  test::add_disc(p, 89.3, 20.6, 3, 9000);
  Finder find;
  const Blobs& blobs = find(p);
  ASSERT_EQ(blobs.count, 3);
  const auto at = [&](double x) -> const Blob& {
    return *std::find_if(blobs.items.begin(), blobs.items.begin() + 3,
                         [&](const Blob& blob) { return blob.x0 <= x && x < blob.x1; });
  };
  EXPECT_EQ(at(20).flags, 0);
  EXPECT_LT(at(20).variance_px2[0], 0.01F);
  EXPECT_EQ(at(53).flags, k_blob_partial_or_merged);
  EXPECT_GE(at(53).variance_px2[0], 9.0F);  // each disc's centre is three pixels away
  EXPECT_NE(at(89).flags & k_blob_touches_edge, 0);
  EXPECT_GT(at(89).variance_px2[0], 1.0F);
  EXPECT_GT(at(89).variance_px2[0], at(89).variance_px2[1] + 0.9F);
}

TEST(Blobs, HaveThePlainMeanWhereThePixelsAreUsedUp) {
  TestImage picture(20, 9);
  for (int i = 0; i < 12; ++i) picture(3 + i % 4, 3 + i / 4) = 600;
  picture(3, 3) = 5000;  // has the largest weight in any weighted mean
  Finder find;
  EXPECT_LT(find(picture).items[0].centroid_px.x(), 4.9);
  find.limits.blobs = 1;
  find.limits.centroid_pixels_per_blob = 4;
  const Blobs& blobs = find(picture);
  EXPECT_EQ(blobs.reason, Reason::blobs_full);
  EXPECT_EQ(blobs.items[0].centroid_px, Vector2(5, 4.5));
}

}  // namespace
}  // namespace glint::blobs_test
