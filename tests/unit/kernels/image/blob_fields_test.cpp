// find_blobs: every field of a blob, selection under a blob limit, and independence of the previous
// frame.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <memory>
#include <vector>

#include "kernels/image/blobs.hpp"
#include "kernels/image/centroid.hpp"
#include "kernels/image/centroid_variance.hpp"
#include "kernels/image/marker_misfit.hpp"
#include "kernels/image/roi_threshold.hpp"
#include "tests/unit/kernels/image/blob_finder.hpp"
#include "tests/unit/kernels/image/test_image.hpp"

namespace glint::blob_fields_test {
namespace {

using test::BlobFinder;
using test::TestImage;

// Returns an image of `count` isolated pixels above the threshold, 20 a row.
TestImage dots(int count) {
  TestImage p(80, 80);
  for (int i = 0; i < count; ++i) p(i % 20 * 4 + 1, i / 20 * 4 + 1) = 1000;
  return p;
}

// All fields of a blob have different values, from its component and its centroid.
TEST(Blobs, HaveTheirComponentsBoxAndTheirCentroidsFigures) {
  TestImage p(60, 50, 50);
  for (int y = 20; y < 26; ++y)
    for (int x = 11; x < 19; ++x) p(x, y) = static_cast<std::uint16_t>(3000 + 17 * x + 5 * y);
  p(11, 20) = 60;  // outside the blob: the area differs from the box's
  p(14, 22) = 7777;
  BlobFinder find;
  find.settings.noise = {20, 0.5, 0.02};
  find(p);
  ASSERT_EQ(find.blobs->count, 1);
  const Blob& blob = find.blobs->items[0];
  EXPECT_EQ(blob.x0, 11);
  EXPECT_EQ(blob.y0, 20);
  EXPECT_EQ(blob.x1, 19);
  EXPECT_EQ(blob.y1, 26);
  EXPECT_EQ(blob.area_px, 47u);
  EXPECT_EQ(blob.peak, 7777);
  EXPECT_EQ(blob.flags, 0);
  const Component& component = find.scratch->components[0];
  const Centroid centroid =
      grown_centroid(p.frame(), *find.scratch, component, find.settings.threshold);
  EXPECT_EQ(blob.centroid_px, centroid.position_px);
  EXPECT_EQ(blob.variance_px2, centroid_variance(centroid, component, find.settings));
  EXPECT_NE(blob.variance_px2[0], blob.variance_px2[1]);
}

// A partially occluded blob, a cut one and one that is both: variance is the centroid's plus the
// shape's.
TEST(Blobs, AddTheirShapesVarianceAlongEachAxis) {
  struct Case {
    int x0, y0, width, height;
    bool cut_x, cut_y;
  };
  for (const Case& c : {Case{20, 20, 9, 3, false, false},
                        {0, 20, 5, 4, true, false},
                        {20, 0, 4, 5, false, true},
                        {0, 0, 9, 4, true, true}}) {
    TestImage p(60, 50);
    for (int y = c.y0; y < c.y0 + c.height; ++y)
      for (int x = c.x0; x < c.x0 + c.width; ++x) p(x, y) = 4000;
    BlobFinder find;
    find(p);
    ASSERT_EQ(find.blobs->count, 1);
    const Component& component = find.scratch->components[0];
    const auto own = centroid_variance(
        grown_centroid(p.frame(), *find.scratch, component, find.settings.threshold), component,
        find.settings);
    const float excess = static_cast<float>(std::abs(c.width - c.height)) / 2;
    const float x = excess + (c.cut_x ? 1 : 0), y = excess + (c.cut_y ? 1 : 0);
    EXPECT_FLOAT_EQ(find.blobs->items[0].variance_px2[0], own[0] + x * x) << c.width;
    EXPECT_FLOAT_EQ(find.blobs->items[0].variance_px2[1], own[1] + y * y) << c.width;
  }
}

TEST(Blobs, AreThoseOfAFreshFinderWhateverTheFrameBeforeHad) {
  TestImage few(80, 80);
  test::add_disc(few, 30.3, 20.6, 3, 9000);
  test::add_disc(few, 50.3, 40.6, 4, 9000);
  BlobFinder used, fresh;
  used.limits.blobs = fresh.limits.blobs = 16;
  used(dots(400));
  EXPECT_EQ(used.blobs->reason, Reason::blobs_full);
  const BlobWork after = used(few), alone = fresh(few);
  EXPECT_EQ(used.blobs->count, fresh.blobs->count);
  EXPECT_EQ(used.blobs->dropped, 0u);
  EXPECT_EQ(used.blobs->left_out, 0u);
  EXPECT_EQ(used.blobs->reason, Reason::none);
  EXPECT_EQ(used.blobs->incomplete, Reason::none);
  EXPECT_EQ(after.runs, alone.runs);
  EXPECT_EQ(after.pixels, alone.pixels);
  for (std::size_t i = 0; i < 2; ++i)
    EXPECT_EQ(used.blobs->items[i].centroid_px, fresh.blobs->items[i].centroid_px);
}

// One band's run buffer is full: either band's overflow flags the blobs as incomplete.
TEST(Blobs, MissWhatAnyBandLost) {
  const TestImage p = dots(40);
  const Frame frame = p.frame();
  for (const int full : {0, 1}) {
    std::array<std::unique_ptr<Runs>, 2> bands{std::make_unique<Runs>(), std::make_unique<Runs>()};
    for (const int band : {0, 1}) {
      Limits limits;
      limits.runs_per_band = band == full ? 3 : k_runs_per_band_max;
      threshold_runs(frame, whole_frame(frame), 500, {band, 20}, *bands[std::size_t(band)], limits);
    }
    BlobFinder find;
    const Runs* both[] = {bands[0].get(), bands[1].get()};
    find_blobs(frame, both, find.settings, {}, *find.scratch, *find.blobs);
    EXPECT_EQ(find.blobs->reason, Reason::runs_full) << full;
    EXPECT_EQ(find.blobs->incomplete, Reason::runs_full) << full;
    EXPECT_EQ(find.blobs->count, 3 + 20) << full;
  }
}

// Selected dots and discs against a full sort by distance to the predictions and misfit.
TEST(Blobs, KeepThoseOfAPlainSortByDistanceAndMisfit) {
  std::mt19937 random(8);
  for (int round = 0; round < 20; ++round) {
    TestImage p(200, 200);
    for (int i = 0; i < 12; ++i)
      test::add_disc(p, 10 + static_cast<int>(random() % 180),
                     10 + static_cast<int>(random() % 180), 1 + static_cast<int>(random() % 5),
                     9000);
    for (int i = 0; i < 40; ++i)
      p(static_cast<int>(random() % 200), static_cast<int>(random() % 200)) = 700;
    p(0, 0) = 700;  // first and last component; fit no marker
    p(199, 199) = 700;
    BlobFinder find;
    find.settings.sizes = marker_sizes({0.0055, 0.0055, 0.8, 253, 0.15, 1.0, 0.001, 4090});
    find.predicted = {{5, 5}, {190, 190}};
    find(p);
    const int all = find.scratch->component_count;
    std::vector<std::pair<long, int>> order;
    for (int i = 0; i < all; ++i) {
      const Component& c = find.scratch->components[static_cast<std::size_t>(i)];
      long least = (1 << 23) - 1;
      for (const Vector2& at : find.predicted) {
        const long dx = c.x0 + c.x1 - static_cast<long>(2 * at.x());
        const long dy = c.y0 + c.y1 - static_cast<long>(2 * at.y());
        least = std::min(least, dx * dx + dy * dy);
      }
      for (int step = marker_misfit(p.frame(), c, find.settings); step > 0; --step) least *= 4;
      order.emplace_back(least, i);
    }
    std::sort(order.begin(), order.end());
    find.limits.blobs = 2 + static_cast<int>(random() % 20);
    std::vector<std::array<int, 2>> expected, kept;
    for (int i = 0; i < find.limits.blobs; ++i) {
      const Component& c =
          find.scratch
              ->components[static_cast<std::size_t>(order[static_cast<std::size_t>(i)].second)];
      expected.push_back({c.y0, c.x0});
    }
    std::sort(expected.begin(), expected.end());
    find(p);
    for (int i = 0; i < find.blobs->count; ++i) {
      const Blob& blob = find.blobs->items[static_cast<std::size_t>(i)];
      kept.push_back({blob.y0, blob.x0});
    }
    ASSERT_EQ(kept, expected) << "round " << round;
  }
}
}  // namespace
}  // namespace glint::blob_fields_test
