#include "kernels/image/components.hpp"

#include <gtest/gtest.h>

#include <array>
#include <memory>
#include <vector>

#include "kernels/image/grown_box.hpp"
#include "kernels/image/roi_threshold.hpp"
#include "tests/unit/kernels/image/test_image.hpp"

namespace glint::components_test {
namespace {

using test::TestImage;

struct Found {
  std::array<std::unique_ptr<Runs>, k_row_bands + 1> runs;
  std::unique_ptr<BlobScratch> scratch = std::make_unique<BlobScratch>();

  Found() {
    for (auto& band : runs) band = std::make_unique<Runs>();
  }
  void find(const TestImage& picture, int bands, int runs_per_band = k_runs_per_band_max) {
    const Frame frame = picture.frame();
    std::vector<const Runs*> list;
    for (int band = 0; band < bands; ++band) {
      Runs& out = *runs[static_cast<std::size_t>(band)];
      threshold_runs(frame, whole_frame(frame), 500, {band, bands}, out);
      list.push_back(&out);
    }
    find_components(list, *scratch, runs_per_band);
  }
};

// Flood fill, a reference without runs: left, top, right, bottom and area of each component.
std::vector<std::array<int, 5>> boxes_by_flood(TestImage p) {
  std::vector<std::array<int, 5>> boxes;
  for (int y = 0; y < p.height; ++y) {
    for (int x = 0; x < p.width; ++x) {
      if (p(x, y) <= 500) continue;
      std::array<int, 5> box{x, y, x + 1, y + 1, 0};
      std::vector<std::array<int, 2>> open{{x, y}};
      p(x, y) = 0;
      while (!open.empty()) {
        const auto [cx, cy] = open.back();
        open.pop_back();
        box = {std::min(box[0], cx), std::min(box[1], cy), std::max(box[2], cx + 1),
               std::max(box[3], cy + 1), box[4] + 1};
        for (int i = 0; i < 9; ++i) {
          const int nx = cx + i % 3 - 1, ny = cy + i / 3 - 1;
          if (nx < 0 || ny < 0 || nx >= p.width || ny >= p.height || p(nx, ny) <= 500) continue;
          p(nx, ny) = 0;
          open.push_back({nx, ny});
        }
      }
      boxes.push_back(box);
    }
  }
  return boxes;
}

// Components are in the order of their first pixels, and each run is in exactly one chain.
TEST(Components, HaveTheBoxesAreasAndRunsOfAFloodFill) {
  std::mt19937 random(11);
  Found found;
  for (int round = 0; round < 300; ++round) {
    TestImage p(static_cast<int>(1 + random() % 40), static_cast<int>(4 + random() % 30));
    const unsigned density = 1 + random() % 9;
    for (auto& value : p.pixels_16) value = random() % 10 < density ? 1000 : 0;
    found.find(p, 1 + round % k_row_bands);
    const BlobScratch& scratch = *found.scratch;
    const auto expected = boxes_by_flood(p);
    ASSERT_EQ(scratch.component_count, static_cast<int>(expected.size())) << "round " << round;
    int chained = 0;
    for (std::size_t i = 0; i < expected.size(); ++i) {
      const Component& c = scratch.components[i];
      const std::array<int, 5> box{c.x0, c.y0, c.x1, c.y1, static_cast<int>(c.area_px)};
      ASSERT_EQ(box, expected[i]) << "round " << round;
      int pixels = 0;
      for (std::uint16_t run = c.first_run;; run = scratch.next_run[run]) {
        pixels += scratch.runs[run].x1() - scratch.runs[run].x0();
        ASSERT_LE(++chained, scratch.run_count);
        if (run == c.last_run) break;
      }
      ASSERT_EQ(pixels, box[4]) << "round " << round;
    }
    ASSERT_EQ(chained, scratch.run_count);
  }
}

TEST(Components, ReadNoMoreBandsAndRunsThanThereAre) {
  TestImage p(9, 10);
  for (int y = 0; y < 10; y += 2)
    for (int x = 0; x < 9; x += 2) p(x, y) = 1000;
  Found found;
  found.find(p, k_row_bands + 1);  // a band has two rows, one of them with five dots
  EXPECT_EQ(found.scratch->run_count, k_row_bands * 5);
  EXPECT_EQ(found.scratch->component_count, k_row_bands * 5);
  found.find(p, 2, 3);
  EXPECT_EQ(found.scratch->run_count, 2 * 3);
  found.find(p, 2, 0);
  EXPECT_EQ(found.scratch->run_count, 0);
  EXPECT_EQ(found.scratch->component_count, 0);
  found.find(p, 2, -1);
  EXPECT_EQ(found.scratch->run_count, 0);
  found.runs[0]->count = -5;
  const Runs* negative[] = {found.runs[0].get()};
  find_components(negative, *found.scratch);
  EXPECT_EQ(found.scratch->run_count, 0);
  find_components({}, *found.scratch);
  EXPECT_EQ(found.scratch->component_count, 0);
}

// Two pixels around the blob, inside the frame, with a width that is a multiple of eight columns.
TEST(GrownBox, HoldsTheBlobAndTwoPixelsAroundIt) {
  std::mt19937 random(12);
  for (int round = 0; round < 2000; ++round) {
    const auto below = [&](int n) { return static_cast<int>(random() % static_cast<unsigned>(n)); };
    const TestImage p(1 + below(90), 1 + below(90));
    Component c;
    c.x0 = static_cast<std::uint16_t>(below(p.width));
    c.y0 = static_cast<std::uint16_t>(below(p.height));
    c.x1 = static_cast<std::uint16_t>(c.x0 + 1 + below(std::min(p.width - c.x0, k_grown_box_max)));
    c.y1 = static_cast<std::uint16_t>(c.y0 + 1 + below(std::min(p.height - c.y0, k_grown_box_max)));
    const GrownBox box = grown_box(p.frame(), c);
    const int begin = std::max(c.x0 - 2, 0), end = std::min(c.x1 + 2, p.width);
    EXPECT_GE(box.left, 0);
    EXPECT_LE(box.left, begin);
    EXPECT_GE(box.left + 8 * box.column_groups, end);
    EXPECT_LT(8 * (box.column_groups - 1), end - begin) << "no eight too many";
    if (p.width >= 8 * box.column_groups) {
      EXPECT_LE(box.left + 8 * box.column_groups, p.width);
      EXPECT_EQ(box.left, std::min(begin, p.width - 8 * box.column_groups));
    } else {
      EXPECT_EQ(box.left, 0);
    }
    EXPECT_EQ(box.top, std::max(c.y0 - 2, 0));
    EXPECT_EQ(box.bottom, std::min(c.y1 + 2, p.height));
    EXPECT_EQ(box.pixels(), (box.bottom - box.top) * (8 * box.column_groups + 8));
    ASSERT_FALSE(HasFailure()) << round;
  }
}

TEST(GrownBox, FitsUpToItsLargestSideEachWay) {
  const auto fits = [](int width, int height) {
    Component c;
    c.x0 = 7;
    c.y0 = 9;
    c.x1 = static_cast<std::uint16_t>(7 + width);
    c.y1 = static_cast<std::uint16_t>(9 + height);
    return fits_grown_box(c);
  };
  EXPECT_TRUE(fits(k_grown_box_max, k_grown_box_max));
  EXPECT_FALSE(fits(k_grown_box_max + 1, 1));
  EXPECT_FALSE(fits(1, k_grown_box_max + 1));
}

}  // namespace
}  // namespace glint::components_test
