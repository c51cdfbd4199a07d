// Work counts of the run-length threshold, and the frames, bands and ROIs that it accepts. The
// reference version must meet the same expectations.
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <vector>

#include "kernels/image/roi_threshold.hpp"
#include "tests/unit/kernels/image/test_image.hpp"

namespace glint::threshold_work_test {
namespace {

using test::TestImage;

Rois rois_of(const std::vector<Roi>& items) {
  Rois rois;
  for (const Roi& roi : items) rois.items[static_cast<std::size_t>(rois.count++)] = roi;
  return rois;
}

ThresholdWork work_of(const TestImage& picture, const Rois& rois, RowBand band = {},
                      const Limits& limits = {}) {
  auto runs = std::make_unique<Runs>();
  const ThresholdWork work = threshold_runs(picture.frame(), rois, 100, band, *runs, limits);
  EXPECT_EQ(work.runs, runs->count);
  return work;
}

// Returns the number of runs; both versions must agree.
int runs_of(const TestImage& picture, const Rois& rois, RowBand band = {},
            const Limits& limits = {}) {
  auto fast = std::make_unique<Runs>(), plain = std::make_unique<Runs>();
  threshold_runs(picture.frame(), rois, 100, band, *fast, limits);
  threshold_runs_reference(picture.frame(), rois, 100, band, *plain, limits);
  EXPECT_EQ(fast->count, plain->count);
  return fast->count;
}

int blocks_of(int pixels, int block) { return (pixels + block - 1) / block; }

TEST(ThresholdWork, IsAStretchARoiAndRowAndABlockEach64Bytes) {
  TestImage wide(200, 9);
  wide(33, 4) = wide(40, 4) = 500;
  for (const bool narrow : {false, true}) {
    const TestImage picture = narrow ? wide.with_8_bits() : wide;
    const int block = narrow ? 64 : 32;
    for (const int pixels : {1, 31, 32, 33, 63, 64, 65, 130}) {
      const ThresholdWork work =
          work_of(picture, rois_of({{5, 1, 5 + pixels, 3}, {150, 0, 151, 9}}));
      EXPECT_EQ(work.stretches, 2 * 9) << pixels;
      EXPECT_EQ(work.blocks, 2 * blocks_of(pixels, block) + 9) << pixels;
      EXPECT_EQ(work.runs, 0);
    }
    EXPECT_EQ(work_of(picture, whole_frame(picture.frame())).runs, 2);
  }
}

// Pixels in overlapping ROIs are read once, in any order of the ROIs.
TEST(ThresholdWork, CountsAnOverlapOnceInAnyOrder) {
  const TestImage picture(200, 4);
  std::vector<Roi> rois = {{0, 0, 40, 4}, {0, 1, 150, 3}, {100, 0, 180, 2}, {160, 2, 190, 4}};
  std::vector<std::size_t> order = {0, 1, 2, 3};
  // Row 0: 40 and 80 pixels; row 1: 40, 110 and 30; row 2: 40, 110 and 30; row 3: 40 and 30.
  const int blocks = (2 + 3) + (2 + 4 + 1) + (2 + 4 + 1) + (2 + 1);
  do {
    std::vector<Roi> listed;
    for (const std::size_t i : order) listed.push_back(rois[i]);
    const ThresholdWork work = work_of(picture, rois_of(listed));
    EXPECT_EQ(work.stretches, 4 * 4);
    EXPECT_EQ(work.blocks, blocks);
  } while (std::next_permutation(order.begin(), order.end()));
}

TEST(ThresholdWork, AddsUpOverTheBands) {
  TestImage picture(150, 11);
  for (int y = 0; y < 11; ++y) picture(3 * y, y) = picture(100, y) = 500;
  const Rois rois = rois_of({{0, 2, 90, 9}, {95, 0, 150, 11}});
  const ThresholdWork whole = work_of(picture, rois);
  for (const int bands : {2, 3, 4, 11}) {
    ThresholdWork sum;
    for (int band = 0; band < bands; ++band) {
      const ThresholdWork work = work_of(picture, rois, {band, bands});
      sum.blocks += work.blocks;
      sum.runs += work.runs;
    }
    EXPECT_EQ(sum.blocks, whole.blocks) << bands;
    EXPECT_EQ(sum.runs, whole.runs) << bands;
  }
}

// Row 2 has the third run, in the second of its three blocks.
TEST(ThresholdWork, EndsWithTheBlockThatFindsTheBufferFull) {
  TestImage picture(96, 6);
  picture(5, 0) = picture(5, 1) = picture(40, 2) = picture(90, 2) = picture(5, 3) = 500;
  Limits limits;
  limits.runs_per_band = 2;
  const ThresholdWork work = work_of(picture, whole_frame(picture.frame()), {}, limits);
  EXPECT_EQ(work.stretches, 3);
  EXPECT_EQ(work.blocks, 3 + 3 + 3);
  EXPECT_EQ(work.runs, 2);
  // In the lower half of the rows the first row meets the full buffer.
  limits.runs_per_band = 0;
  const ThresholdWork lower = work_of(picture, whole_frame(picture.frame()), {1, 2}, limits);
  EXPECT_EQ(lower.stretches, 1);
  EXPECT_EQ(lower.runs, 0);
}

TEST(ThresholdWork, ReachesItsMaximumWhereEachRoiHasAPixelMoreThanItsBlocks) {
  Limits limits;
  limits.width = 100;
  limits.height = 10;
  limits.tools = 3;
  limits.runs_per_band = 4000;
  TestImage picture(100, 10);
  for (int y = 0; y < 10; ++y)
    for (int x = y % 2; x < 100; x += 2) picture(x, y) = 500;
  const Rois rois = rois_of({{0, 0, 33, 10}, {33, 0, 66, 10}, {66, 0, 100, 10}});
  for (const int bands : {1, 3, 4}) {
    const ThresholdWork most = threshold_work_max(limits, bands);
    ThresholdWork largest;
    for (int band = 0; band < bands; ++band) {
      const ThresholdWork work = work_of(picture, rois, {band, bands}, limits);
      largest.stretches = std::max(largest.stretches, work.stretches);
      largest.blocks = std::max(largest.blocks, work.blocks);
      largest.runs = std::max(largest.runs, work.runs);
    }
    EXPECT_EQ(most.stretches, largest.stretches) << bands;
    EXPECT_EQ(most.blocks, largest.blocks) << bands;
    EXPECT_EQ(most.runs, largest.runs) << bands;
  }
}

TEST(ThresholdWork, MaximumFollowsTheLimits) {
  Limits limits;
  limits.width = 101;
  limits.height = 9;
  limits.tools = 2;
  limits.reflectivity_bytes = 1;
  limits.runs_per_band = 70;
  const ThresholdWork half = threshold_work_max(limits, 2);  // 5 rows, blocks of 64 pixels
  EXPECT_EQ(half.stretches, 5 * 2);
  EXPECT_EQ(half.blocks, 5 * (99 / 64 + 2));
  EXPECT_EQ(half.runs, 70);
  limits.runs_per_band = 1000;
  EXPECT_EQ(threshold_work_max(limits, 2).runs, 5 * 51);
  limits.tools = 0;  // the frame as one ROI
  EXPECT_EQ(threshold_work_max(limits, 1).stretches, 9);
  limits.tools = 16;
  limits.width = 5;  // at most as many ROIs as columns
  EXPECT_EQ(threshold_work_max(limits, 1).stretches, 9 * 5);
}

TEST(ThresholdLimits, TakeAFrameAtEachAndNoneBeyond) {
  TestImage wide(40, 30);
  wide(39, 29) = 500;
  const TestImage narrow = wide.with_8_bits();
  const auto found = [](const TestImage& picture, int width, int height, int bytes) {
    Limits limits;
    limits.width = width;
    limits.height = height;
    limits.reflectivity_bytes = bytes;
    return runs_of(picture, whole_frame(picture.frame()), {}, limits);
  };
  EXPECT_EQ(found(wide, 40, 30, 2), 1);
  EXPECT_EQ(found(wide, 39, 30, 2), 0);
  EXPECT_EQ(found(wide, 40, 29, 2), 0);
  EXPECT_EQ(found(wide, 40, 30, 1), 0);
  EXPECT_EQ(found(narrow, 40, 30, 1), 1);
  EXPECT_EQ(found(narrow, 40, 30, 0), 0);
  EXPECT_EQ(found(narrow, 40, 29, 1), 0);
}

// Hard limits of columns and rows in a run, for any cell limits.
TEST(ThresholdLimits, NeverExceedTheLargestFrame) {
  Limits limits;
  limits.width = limits.height = 5000;
  for (const int beyond : {0, 1}) {
    TestImage wide(k_width_max + beyond, 1), high(1, k_height_max + beyond);
    wide(0, 0) = high(0, 0) = 500;
    EXPECT_EQ(runs_of(wide, whole_frame(wide.frame()), {}, limits), 1 - beyond);
    EXPECT_EQ(runs_of(high, whole_frame(high.frame()), {}, limits), 1 - beyond);
  }
}

TEST(ThresholdLimits, TakeEachBandOfAllAndNoOther) {
  const TestImage picture(4, 4, 500);
  const Rois all = whole_frame(picture.frame());
  EXPECT_EQ(runs_of(picture, all, {0, 1}), 4);
  EXPECT_EQ(runs_of(picture, all, {0, 2}), 2);
  EXPECT_EQ(runs_of(picture, all, {1, 2}), 2);
  for (const RowBand band : {RowBand{2, 2}, {-1, 2}, {0, 0}, {0, -1}, {1, 1}})
    EXPECT_EQ(runs_of(picture, all, band), 0) << band.index << " of " << band.count;
}

// More ROIs than tools are replaced by the frame. The tool limit is clamped to 1 .. k_tools_max.
TEST(ThresholdLimits, TakeAsManyRoisAsTools) {
  const TestImage picture(64, 1, 500);
  const auto pixels = [&](int tools, int count) {
    Limits limits;
    limits.tools = tools;
    Rois rois;
    rois.count = count;
    for (int i = 0; i < k_tools_max; ++i)
      rois.items[static_cast<std::size_t>(i)] = {2 * i, 0, 2 * i + 1, 1};
    return runs_of(picture, rois, {}, limits);
  };
  EXPECT_EQ(pixels(3, 2), 2);
  EXPECT_EQ(pixels(3, 3), 3);
  EXPECT_EQ(pixels(3, 4), 1) << "the frame";
  EXPECT_EQ(pixels(2, 2), 2);
  for (const int tools : {0, -3, 1}) {
    EXPECT_EQ(pixels(tools, 1), 1);
    EXPECT_EQ(pixels(tools, 2), 1) << "the frame";
  }
  EXPECT_EQ(pixels(k_tools_max, k_tools_max), k_tools_max);
  EXPECT_EQ(pixels(99, k_tools_max), k_tools_max);
  EXPECT_EQ(pixels(99, k_tools_max + 1), 1) << "the frame";
  EXPECT_EQ(pixels(3, 0), 0);
  EXPECT_EQ(pixels(3, -1), 0);
}

// Too many ROIs are replaced by the frame, also in the work counts.
TEST(ThresholdWork, OfTooManyRoisIsThatOfTheFrame) {
  const TestImage picture(70, 6);
  Limits limits;
  limits.tools = 1;
  const ThresholdWork work =
      work_of(picture, rois_of({{0, 0, 1, 1}, {3, 3, 4, 4}}), {1, 2}, limits);
  EXPECT_EQ(work.stretches, 3);
  EXPECT_EQ(work.blocks, 3 * blocks_of(70, 32));
}

// ROIs without a pixel of the frame cause no work.
TEST(ThresholdWork, SkipsRoisWithoutAPixelOfTheBand) {
  const TestImage picture(64, 8, 500);
  const Roi empty[] = {{5, 1, 5, 3},   {6, 1, 5, 3},  {5, 3, 9, 3},  {5, 4, 9, 3},
                       {64, 0, 70, 8}, {-9, 0, 0, 8}, {0, 8, 64, 9}, {0, -2, 64, 0}};
  for (const Roi& roi : empty) {
    EXPECT_EQ(work_of(picture, rois_of({roi})).stretches, 0);
    EXPECT_EQ(work_of(picture, rois_of({roi, {0, 0, 1, 1}})).stretches, 8);
  }
  EXPECT_EQ(work_of(picture, rois_of({{0, 0, 64, 4}}), {1, 2}).stretches, 0);
  EXPECT_EQ(work_of(picture, rois_of({{0, 0, 64, 5}}), {1, 2}).blocks, 2);
}

}  // namespace
}  // namespace glint::threshold_work_test
