// Work counts of find_blobs and their limits.
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <vector>

#include "kernels/image/blobs.hpp"
#include "kernels/image/grown_box.hpp"
#include "kernels/image/roi_threshold.hpp"
#include "tests/unit/kernels/image/blob_finder.hpp"
#include "tests/unit/kernels/image/test_image.hpp"

namespace glint::blob_work_test {
namespace {

using test::BlobFinder;
using test::TestImage;

// Returns an image of `count` isolated pixels above the threshold, 20 a row.
TestImage dots(int count) {
  TestImage p(80, 80);
  for (int i = 0; i < count; ++i) p(i % 20 * 4 + 1, i / 20 * 4 + 1) = 1000;
  return p;
}

TEST(BlobWork, CountsRunsBlobsAndTheGrownBoxesPixels) {
  BlobFinder find;
  TestImage p(100, 60);
  for (int y = 10; y < 14; ++y)
    for (int x = 20; x < 25; ++x) p(x, y) = 2000;
  p(0, 40) = 2000;
  const BlobWork work = find(p);
  EXPECT_EQ(work.runs, 5);
  EXPECT_EQ(work.blobs, 2);
  EXPECT_EQ(work.distances, 0);
  // 9 columns count as two groups of eight; the masks of a row cost as much as one more group.
  EXPECT_EQ(work.pixels, 8 * 8 * 3 + 8 * 5 * 2);
}

TEST(BlobWork, OfTwoBlobsIsTheSumOfBoth) {
  const auto work_of = [](bool left, bool right) {
    TestImage p(120, 60);
    if (left) test::add_disc(p, 30.2, 30.7, 4, 9000);
    if (right) test::add_disc(p, 80.4, 25.1, 6.3, 9000);
    return BlobFinder{}(p);
  };
  const BlobWork one = work_of(true, false), other = work_of(false, true),
                 both = work_of(true, true);
  EXPECT_EQ(both.runs, one.runs + other.runs);
  EXPECT_EQ(both.blobs, 2);
  EXPECT_EQ(both.pixels, one.pixels + other.pixels);
}

TEST(BlobWork, CountsNoPixelsOfABoxThatIsNotWeighed) {
  for (const int side : {k_grown_box_max, k_grown_box_max + 1}) {
    for (const bool wide : {false, true}) {
      TestImage p(100, 100);
      for (int i = 0; i < side; ++i) (wide ? p(10 + i, 20) : p(20, 10 + i)) = 2000;
      BlobFinder find;
      const BlobWork work = find(p);
      EXPECT_EQ(work.pixels > 0, side == k_grown_box_max) << side << wide;
      EXPECT_EQ(find.blobs->reason, Reason::none) << "a large blob lacks nothing";
      EXPECT_EQ(find.blobs->items[0].area_px, static_cast<unsigned>(side));
    }
  }
}

TEST(BlobWork, CountsFourDistancesAPredictionAndTheFocusOnlyWhereThereAreTooMany) {
  BlobFinder find;
  find.limits.blobs = 10;
  find.predicted = {{20, 20}, {30, 30}, {40, 20}};
  EXPECT_EQ(find(dots(10)).distances, 0);
  EXPECT_EQ(find.blobs->reason, Reason::none);
  EXPECT_EQ(find.blobs->count, 10);
  EXPECT_EQ(find(dots(11)).distances, 3 * 3);
  EXPECT_EQ(find.blobs->reason, Reason::blobs_full);
  EXPECT_EQ(find.blobs->incomplete, Reason::blobs_full);
  EXPECT_EQ(find.blobs->count, 10);
  EXPECT_EQ(find(dots(13)).distances, 4 * 3);
  find.everywhere = true;
  EXPECT_EQ(find(dots(13)).distances, 4 * (3 + 1));
  find.predicted.clear();
  EXPECT_EQ(find(dots(13)).distances, 4);
}

// One tool of two markers: find_blobs ignores further predictions.
TEST(BlobWork, LooksAtNoMorePredictionsThanTheCellsToolsHaveMarkers) {
  BlobFinder find;
  find.limits.blobs = 8;
  find.limits.tools = 1;
  find.limits.markers_per_tool = 2;
  find.predicted = {{10, 10}, {10, 10}, {78, 78}};
  EXPECT_EQ(find(dots(400)).distances, 100 * 2);
  for (int i = 0; i < 8; ++i) EXPECT_LT(find.blobs->items[static_cast<std::size_t>(i)].x0, 40);
}

TEST(BlobWork, KeepsAsManyAsTheLimitAndNeverMoreThanThereIsRoomFor) {
  for (const int most : {-4, 0, 1, 7, k_blobs_max, k_blobs_max + 50}) {
    BlobFinder find;
    find.limits.blobs = most;
    const BlobWork work = find(dots(400));
    const int kept = std::clamp(most, 0, k_blobs_max);
    EXPECT_EQ(find.blobs->count, kept);
    EXPECT_EQ(work.blobs, kept);
    EXPECT_EQ(find.blobs->left_out, 400u - static_cast<unsigned>(kept));
    EXPECT_EQ(find.blobs->dropped, 400u - static_cast<unsigned>(kept));
  }
}

// A box that costs exactly its share has the grown centroid; with one pixel less, the plain mean.
TEST(BlobWork, PaysForABoxThatCostsJustWhatIsLeft) {
  TestImage p(40, 40);
  for (int y = 10; y < 14; ++y)
    for (int x = 12; x < 16; ++x) p(x, y) = 2000;
  p(12, 10) = 9000;
  const int cost = 8 * 8 * 2;
  for (const int less : {0, 1}) {
    BlobFinder find;
    find.limits.blobs = 1;
    find.limits.centroid_pixels_per_blob = cost - less;
    const BlobWork work = find(p);
    EXPECT_EQ(work.pixels, less == 0 ? cost : 0);
    EXPECT_EQ(find.blobs->reason, less == 0 ? Reason::none : Reason::blobs_full);
    EXPECT_EQ(find.blobs->incomplete, Reason::none) << "all blobs are here";
    EXPECT_EQ(find.blobs->items[0].centroid_px == Vector2(14, 12), less == 1);
  }
}

TEST(BlobWork, ReachesItsMaximumAndFollowsTheLimits) {
  Limits limits;
  limits.width = 30;
  limits.height = 9;
  limits.tools = 2;
  limits.markers_per_tool = 3;
  limits.blobs = 20;
  limits.runs_per_band = 1000;
  limits.centroid_pixels_per_blob = 50;
  const BlobWork most = blob_work_max(limits);  // four bands of three rows
  EXPECT_EQ(most.runs, 4 * 3 * 15);
  EXPECT_EQ(most.distances, 45 * 7);
  EXPECT_EQ(most.blobs, 20);
  EXPECT_EQ(most.pixels, 20 * 50);
  limits.runs_per_band = 3;
  limits.width = 29;
  EXPECT_EQ(blob_work_max(limits).runs, 12);
  EXPECT_EQ(blob_work_max(limits).distances, 3 * 7);
  EXPECT_EQ(blob_work_max(limits).blobs, 12) << "no more than runs";
  limits.runs_per_band = 1000;
  EXPECT_EQ(blob_work_max(limits).runs, 4 * 3 * 15) << "15 dots in 29 columns";
  limits.height = 8;
  EXPECT_EQ(blob_work_max(limits).runs, 4 * 2 * 15);
}

}  // namespace
}  // namespace glint::blob_work_test
