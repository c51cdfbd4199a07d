#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <numeric>

#include "kernels/image/blobs.hpp"
#include "kernels/image/roi_threshold.hpp"
#include "kernels/merge_sort.hpp"
#include "tests/unit/kernels/image/test_image.hpp"

namespace glint::limits_test {
namespace {

using test::TestImage;

struct Found {
  std::unique_ptr<Runs> runs = std::make_unique<Runs>();
  std::unique_ptr<BlobScratch> scratch = std::make_unique<BlobScratch>();
  std::unique_ptr<Blobs> blobs = std::make_unique<Blobs>();
  BlobWork work;

  Found(const TestImage& picture, const Limits& limits) {
    const Frame frame = picture.frame();
    threshold_runs(frame, whole_frame(frame), 500, {0, 1}, *runs, limits);
    const Runs* bands[] = {runs.get()};
    work = find_blobs(frame, bands, {1, 100000, 500, 0xFFFF}, {}, *scratch, *blobs, limits);
  }
};

TestImage squares(int side, int pitch) {
  TestImage p(512, 512, 100);
  for (int y = 0; y < 512; ++y) {
    for (int x = 0; x < 512; ++x) {
      if (x % pitch >= 4 && x % pitch < 4 + side && y % pitch >= 4 && y % pitch < 4 + side) {
        p(x, y) = 9000;
      }
    }
  }
  return p;
}

TEST(ImageLimits, HoldForRunsAndForBlobs) {
  Limits limits;
  limits.runs_per_band = 50;
  limits.blobs = 3;
  const Found found(squares(2, 16), limits);
  EXPECT_EQ(found.runs->count, 50);
  EXPECT_EQ(found.runs->reason, Reason::runs_full);
  EXPECT_EQ(found.blobs->count, 3);
  EXPECT_EQ(found.blobs->reason, Reason::blobs_full);
  EXPECT_EQ(found.blobs->incomplete, Reason::runs_full);
}

TEST(ImageLimits, RefuseALargerFrame) {
  Limits limits;
  limits.width = 511;
  EXPECT_EQ(Found(squares(2, 16), limits).runs->count, 0);
}

TEST(ImageLimits, TurnTooManyRoisIntoTheWholeFrame) {
  TestImage p(64, 1);
  p(60, 0) = 1000;
  Rois rois;
  rois.count = 3;
  for (int i = 0; i < 3; ++i) rois.items[static_cast<std::size_t>(i)] = {i, 0, i + 1, 1};
  Limits limits;
  limits.tools = 2;
  auto runs = std::make_unique<Runs>();
  threshold_runs(p.frame(), rois, 500, {0, 1}, *runs, limits);
  ASSERT_EQ(runs->count, 1);
  EXPECT_EQ(runs->items[0].x0, 60);
}

// A blob within its share of the pixel budget has the same centroid as without a limit. Larger
// blobs fall back to the plain mean.
TEST(ImageLimits, LeaveSmallBlobsTheirCentroidsWhenLargeOnesComeFirst) {
  TestImage p(512, 512, 100);
  for (int i = 0; i < 8; ++i) test::add_disc(p, 60.3 * i + 40, 40.2, 12, 9000);
  for (int i = 0; i < 8; ++i) test::add_disc(p, 60.3 * i + 40, 200.2, 5, 9000);
  Limits limits;
  limits.blobs = 16;
  const Found all(p, Limits{}), limited(p, limits);
  ASSERT_EQ(all.blobs->count, 16);
  ASSERT_EQ(limited.blobs->count, 16);
  EXPECT_EQ(all.blobs->reason, Reason::none);
  EXPECT_EQ(limited.blobs->reason, Reason::blobs_full);
  EXPECT_LE(limited.work.pixels, limits.blobs * limits.centroid_pixels_per_blob);
  for (std::size_t i = 8; i < 16; ++i) {
    EXPECT_EQ(limited.blobs->items[i].centroid_px, all.blobs->items[i].centroid_px);
  }
  EXPECT_LT((limited.blobs->items[0].centroid_px - all.blobs->items[0].centroid_px).norm(), 0.2);
}

TEST(MergeSort, SortsAsTheStandardOneDoes) {
  std::mt19937 random(2);
  std::array<unsigned, 64> values{}, spare{};
  for (int round = 0; round < 2000; ++round) {
    const int count = static_cast<int>(random() % 65);
    for (unsigned& value : values) value = random() % 50;
    std::array<unsigned, 64> expected = values;
    std::sort(expected.begin(), expected.begin() + count);
    merge_sort(values, spare, count);
    ASSERT_TRUE(std::equal(values.begin(), values.begin() + count, expected.begin())) << count;
  }
}

}  // namespace
}  // namespace glint::limits_test
