#include <gtest/gtest.h>

#include <memory>

#include "kernels/image/roi_threshold.hpp"
#include "tests/unit/kernels/image/test_image.hpp"

namespace glint::threshold_test {
namespace {

using test::image_of;
using test::TestImage;

std::vector<std::array<int, 3>> runs_of(const Frame& frame, const Rois& rois, int threshold,
                                        RowBand band = {}) {
  auto runs = std::make_unique<Runs>();
  threshold_runs(frame, rois, static_cast<std::uint16_t>(threshold), band, *runs);
  std::vector<std::array<int, 3>> out;
  for (int i = 0; i < runs->count; ++i) {
    const Run& run = runs->items[static_cast<std::size_t>(i)];
    out.push_back({run.y, run.x0, run.x1});
  }
  return out;
}

using List = std::vector<std::array<int, 3>>;

TEST(Threshold, WritesRunsByRowsFromLeftToRight) {
  const TestImage p = image_of({"##..#", ".....", "..###"});
  EXPECT_EQ(runs_of(p.frame(), whole_frame(p.frame()), 999),
            (List{{0, 0, 2}, {0, 4, 5}, {2, 2, 5}}));
}

TEST(Threshold, TakesOnlyWhatIsAboveTheThreshold) {
  TestImage p(4, 1);
  p(1, 0) = 250;
  p(2, 0) = 251;
  EXPECT_EQ(runs_of(p.frame(), whole_frame(p.frame()), 250), (List{{0, 2, 3}}));
  const TestImage narrow = p.with_8_bits();
  EXPECT_EQ(runs_of(narrow.frame(), whole_frame(narrow.frame()), 250), (List{{0, 2, 3}}));
  EXPECT_TRUE(runs_of(narrow.frame(), whole_frame(narrow.frame()), 255).empty());
  EXPECT_TRUE(runs_of(narrow.frame(), whole_frame(narrow.frame()), 5000).empty());
}

TEST(Threshold, SeesTheHighestValuesOfSixteenBits) {
  TestImage p(40, 1);
  p(3, 0) = 0x8000;
  p(35, 0) = 0xFFFF;
  const Rois all = whole_frame(p.frame());
  EXPECT_EQ(runs_of(p.frame(), all, 0x7FFF), (List{{0, 3, 4}, {0, 35, 36}}));
  EXPECT_EQ(runs_of(p.frame(), all, 0x8000), (List{{0, 35, 36}}));
  EXPECT_TRUE(runs_of(p.frame(), all, 0xFFFF).empty());
}

TEST(Threshold, JoinsRunsAcrossTheBorderOfTwoRois) {
  const TestImage p = image_of({"########"});
  Rois rois;
  rois.items[0] = {4, 0, 6, 1};  // not in order
  rois.items[1] = {1, 0, 4, 1};
  rois.items[2] = {7, 0, 99, 9};  // beyond the frame
  rois.count = 3;
  EXPECT_EQ(runs_of(p.frame(), rois, 0), (List{{0, 1, 6}, {0, 7, 8}}));
}

TEST(Threshold, ReadsEachRoisRowsAndColumnsHalfOpen) {
  const TestImage p = image_of({"######", "######", "######", "######", "######"});
  Rois rois;
  rois.items[0] = {1, 1, 3, 3};
  rois.items[1] = {4, 2, 5, 4};
  rois.count = 2;
  EXPECT_EQ(runs_of(p.frame(), rois, 0), (List{{1, 1, 3}, {2, 1, 3}, {2, 4, 5}, {3, 4, 5}}));
}

TEST(Threshold, CountsOverlappingRoisOnce) {
  const TestImage p = image_of({"########", "########"});
  Rois rois;
  rois.items[0] = {0, 0, 5, 2};
  rois.items[1] = {3, 1, 7, 2};
  rois.count = 2;
  EXPECT_EQ(runs_of(p.frame(), rois, 0), (List{{0, 0, 5}, {1, 0, 7}}));
}

TEST(Threshold, BandsTogetherAreTheWholeFrame) {
  const TestImage p = image_of({"#", "#", "#", "#", "#"});
  const Rois all = whole_frame(p.frame());
  EXPECT_EQ(runs_of(p.frame(), all, 0, {0, 2}), (List{{0, 0, 1}, {1, 0, 1}}));
  EXPECT_EQ(runs_of(p.frame(), all, 0, {1, 2}), (List{{2, 0, 1}, {3, 0, 1}, {4, 0, 1}}));
}

TEST(Threshold, KeepsTheFirstRunsOfACheckerboardAndSaysThatThereAreMore) {
  TestImage p(512, 512);
  for (int y = 0; y < 512; ++y) {
    for (int x = y % 2; x < 512; x += 2) p(x, y) = 5000;
  }
  auto runs = std::make_unique<Runs>();
  threshold_runs(p.frame(), whole_frame(p.frame()), 100, {0, 2}, *runs);
  EXPECT_EQ(runs->count, k_runs_per_band_max);
  EXPECT_EQ(runs->reason, Reason::runs_full);
  EXPECT_EQ(runs->items[k_runs_per_band_max - 1].y, 15);
  EXPECT_EQ(runs->items[k_runs_per_band_max - 1].x0, 511);
}

// The third run reaches the end of the first ROI and continues in the second.
TEST(Threshold, IsNotFullBeforeOneRunTooManyBegins) {
  Rois rois;
  rois.items[0] = {0, 0, 6, 1};
  rois.items[1] = {6, 0, 12, 1};
  rois.count = 2;
  Limits limits;
  limits.runs_per_band = 3;
  auto runs = std::make_unique<Runs>();
  const TestImage fits = image_of({"#.#.######.."}), more = image_of({"#.#.######.#"});
  threshold_runs(fits.frame(), rois, 100, {}, *runs, limits);
  EXPECT_EQ(runs->count, 3);
  EXPECT_EQ(runs->items[2].x1, 10);
  EXPECT_EQ(runs->reason, Reason::none);
  threshold_runs(more.frame(), rois, 100, {}, *runs, limits);
  EXPECT_EQ(runs->count, 3);
  EXPECT_EQ(runs->items[2].x1, 10);
  EXPECT_EQ(runs->reason, Reason::runs_full);
}

TEST(Threshold, IgnoresFramesAndBandsThatMakeNoSense) {
  const TestImage p = image_of({"##"});
  EXPECT_TRUE(runs_of(Frame{}, whole_frame(p.frame()), 0).empty());
  EXPECT_TRUE(runs_of(p.frame(), Rois{}, 0).empty());
  EXPECT_TRUE(runs_of(p.frame(), whole_frame(p.frame()), 0, {2, 2}).empty());
  EXPECT_TRUE(runs_of(p.frame(), whole_frame(p.frame()), 0, {0, 0}).empty());
}

// Widths that are not a multiple of a block, ROIs at random positions, thresholds in both halves of
// the range.
TEST(Threshold, EqualsThePlainVersionOnRandomFrames) {
  std::mt19937 random(7);
  auto fast = std::make_unique<Runs>(), plain = std::make_unique<Runs>();
  for (int round = 0; round < 400; ++round) {
    const auto below = [&](int n) { return static_cast<int>(random() % static_cast<unsigned>(n)); };
    TestImage p(1 + below(200), 1 + below(40));
    const unsigned sparse = 1u + random() % 40u;
    for (auto& value : p.pixels_16) {
      value = random() % sparse == 0 ? static_cast<std::uint16_t>(random()) : 0;
    }
    if (round % 2 == 0) {
      p = p.with_8_bits();
      for (auto& value : p.pixels_8) value = static_cast<std::uint8_t>(value & random());
    }
    Rois rois;
    rois.count = below(5);
    for (int i = 0; i < rois.count; ++i) {
      const int x = below(210) - 5, y = below(50) - 5;
      rois.items[static_cast<std::size_t>(i)] = {x, y, x + below(150), y + below(40)};
    }
    const int range = p.pixels_8.empty() ? 0x10000 : 0x100;
    const auto threshold = static_cast<std::uint16_t>(below(range));
    const RowBand band{below(3), 3};
    Limits limits;
    if (below(3) == 0) limits.runs_per_band = below(40);
    threshold_runs(p.frame(), rois, threshold, band, *fast, limits);
    threshold_runs_reference(p.frame(), rois, threshold, band, *plain, limits);
    ASSERT_EQ(fast->count, plain->count) << "round " << round;
    ASSERT_EQ(fast->reason, plain->reason);
    for (std::size_t i = 0; i < static_cast<std::size_t>(plain->count); ++i) {
      ASSERT_EQ(fast->items[i].y, plain->items[i].y);
      ASSERT_EQ(fast->items[i].x0, plain->items[i].x0);
      ASSERT_EQ(fast->items[i].x1, plain->items[i].x1);
    }
  }
}

}  // namespace
}  // namespace glint::threshold_test
