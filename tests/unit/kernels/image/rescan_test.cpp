// Second search of oversized components: runs, components, levels and budgets.
#include "kernels/image/rescan.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <memory>
#include <numeric>
#include <random>
#include <vector>

#include "kernels/image/blobs.hpp"
#include "kernels/image/components.hpp"
#include "kernels/image/roi_threshold.hpp"
#include "tests/unit/kernels/image/blob_finder.hpp"
#include "tests/unit/kernels/image/test_image.hpp"
#include "tests/unit/repetitions.hpp"

namespace glint::rescan_test {
namespace {

using test::BlobFinder;
using test::TestImage;

constexpr BlobSettings k_settings{1, 100, 40, 0xFFFF};

// A marker of 3 px radius and 180 counts on a surface of 60.
TestImage marker_on_surface(double x, double y) {
  TestImage p(90, 70, 4);
  test::add_surface(p, 10, 8, 80, 62, 60);
  test::add_disc(p, x, y, 3, 120);
  return p;
}

// --- Reference: floods of pixels, without runs' chains, blocks or union-find. ---

struct Region {
  std::vector<int> pixels;  // row-major indices, sorted
  int level = 0;
};

std::vector<Region> regions_above(const TestImage& p, std::vector<int> inside, int level) {
  std::vector<char> open(p.pixels_16.size(), 0);
  for (const int i : inside)
    open[static_cast<std::size_t>(i)] = p.pixels_16[static_cast<std::size_t>(i)] > level;
  std::vector<Region> regions;
  for (const int start : inside) {
    if (!open[static_cast<std::size_t>(start)]) continue;
    Region region{{start}, level};
    open[static_cast<std::size_t>(start)] = 0;
    for (std::size_t next = 0; next < region.pixels.size(); ++next) {
      const int x = region.pixels[next] % p.width, y = region.pixels[next] / p.width;
      for (int i = 0; i < 9; ++i) {
        const int nx = x + i % 3 - 1, ny = y + i / 3 - 1;
        if (nx < 0 || ny < 0 || nx >= p.width || ny >= p.height) continue;
        const int at = ny * p.width + nx;
        if (!open[static_cast<std::size_t>(at)]) continue;
        open[static_cast<std::size_t>(at)] = 0;
        region.pixels.push_back(at);
      }
    }
    std::sort(region.pixels.begin(), region.pixels.end());
    regions.push_back(std::move(region));
  }
  return regions;
}

std::vector<int> all_pixels(const TestImage& p) {
  std::vector<int> all(p.pixels_16.size());
  std::iota(all.begin(), all.end(), 0);
  return all;
}

int level_above(const TestImage& p, const Region& region) {
  std::vector<std::pair<long, int>> samples;  // of each run: length, value
  for (std::size_t i = 0; i < region.pixels.size();) {
    std::size_t end = i + 1;
    while (end < region.pixels.size() && region.pixels[end] == region.pixels[end - 1] + 1 &&
           region.pixels[end] % p.width != 0)
      ++end;
    const std::size_t length = end - i;
    for (const std::size_t at : {i + length / 4, i + 3 * length / 4})
      samples.emplace_back(length, p.pixels_16[static_cast<std::size_t>(region.pixels[at])]);
    i = end;
  }
  long sum = 0, deviations = 0;
  const auto weight = static_cast<long>(2 * region.pixels.size());
  for (const auto& [length, value] : samples) sum += length * value;
  const long mean = sum / weight;
  for (const auto& [length, value] : samples) deviations += length * std::abs(value - mean);
  return static_cast<int>(std::max(mean * 3 / 2, mean + 3 * (deviations / weight)));
}

std::vector<Region> rescanned_reference(const TestImage& p, int threshold, std::size_t area_max) {
  std::vector<Region> regions = regions_above(p, all_pixels(p), threshold);
  const std::size_t plain = regions.size();
  for (std::size_t i = 0; i < regions.size(); ++i) {
    if (regions[i].pixels.size() <= area_max) continue;
    const std::vector<int> inside = regions[i].pixels;
    for (Region& region : regions_above(p, inside, level_above(p, regions[i])))
      regions.push_back(std::move(region));
  }
  regions.erase(regions.begin(), regions.begin() + static_cast<std::ptrdiff_t>(plain));
  return regions;
}

void expect_equals_reference(const TestImage& p, const BlobFinder& find, int plain, int seed) {
  const auto regions = rescanned_reference(p, find.settings.threshold, find.settings.max_area_px);
  ASSERT_EQ(find.scratch->component_count - plain, static_cast<int>(regions.size())) << seed;
  for (std::size_t i = 0; i < regions.size(); ++i) {
    const Component& found = find.scratch->components[static_cast<std::size_t>(plain) + i];
    const std::vector<int>& pixels = regions[i].pixels;
    ASSERT_EQ(found.area_px, pixels.size()) << seed << ' ' << i;
    ASSERT_EQ(found.level, regions[i].level) << seed << ' ' << i;
    ASSERT_EQ(found.y0, pixels.front() / p.width) << seed << ' ' << i;
    ASSERT_EQ(found.y1, pixels.back() / p.width + 1) << seed << ' ' << i;
    int x0 = p.width, x1 = 0;
    for (const int at : pixels) {
      x0 = std::min(x0, at % p.width);
      x1 = std::max(x1, at % p.width + 1);
    }
    ASSERT_EQ(found.x0, x0) << seed << ' ' << i;
    ASSERT_EQ(found.x1, x1) << seed << ' ' << i;
  }
}

// Surfaces, steps, markers and noise; wider than a block of either pixel format, or narrower.
TestImage random_scene(std::mt19937& random) {
  const auto below = [&](int n) { return static_cast<int>(random() % static_cast<unsigned>(n)); };
  TestImage p(20 + below(90), 20 + below(50), 5);
  for (int i = below(4); i >= 0; --i) {
    const int x = below(p.width), y = below(p.height);
    test::add_surface(p, x, y, std::min(x + 10 + below(70), p.width),
                      std::min(y + 10 + below(40), p.height), 30 + below(90));
  }
  for (int i = below(12); i > 0; --i)
    test::add_disc(p, below(p.width), below(p.height), 1 + 0.1 * below(40), 20 + below(100));
  for (std::uint16_t& value : p.pixels_16)
    value = static_cast<std::uint16_t>(std::min(value + below(20), 255));
  return p;
}

TEST(Rescan, EqualsFloodsOfPixelsInBothPixelFormats) {
  BlobFinder find{k_settings};  // one scratch for all: results do not depend on the last frame
  int components = 0, second_level = 0;
  const int scenes = test::repetitions(600, 40);
  for (int seed = 0; seed < scenes; ++seed) {
    std::mt19937 random(static_cast<unsigned>(seed));
    const TestImage p = random_scene(random);
    for (const bool narrow : {false, true}) {
      find(narrow ? p.with_8_bits() : p);
      const auto plain = regions_above(p, all_pixels(p), find.settings.threshold);
      ASSERT_EQ(find.blobs->incomplete, Reason::none);
      expect_equals_reference(p, find, static_cast<int>(plain.size()), seed);
      components += find.scratch->component_count - static_cast<int>(plain.size());
      for (int i = static_cast<int>(plain.size()); i < find.scratch->component_count; ++i)
        second_level += find.scratch->components[static_cast<std::size_t>(i)].area_px >
                        find.settings.max_area_px;
    }
  }
  EXPECT_GT(components, scenes / 6);
  EXPECT_GE(second_level, scenes / 60) << "some are searched twice";
}

TEST(Rescan, LeavesAFrameInsideTheGateAsItIs) {
  TestImage p(90, 70, 4);
  test::add_disc(p, 30, 30, 3, 180);
  BlobFinder find{k_settings};
  EXPECT_EQ(find(p).rescans, 0);
  EXPECT_EQ(find.scratch->component_count, 1);
  EXPECT_EQ(find.scratch->components[0].level, 0);
}

// Surfaces one in the other, each three times as bright as the one around it.
TEST(Rescan, SearchesLevelByLevel) {
  TestImage p(120, 100, 4);
  const int values[] = {60, 200, 700, 2400};
  for (int i = 0; i < 4; ++i)
    test::add_surface(p, 5 + 10 * i, 5 + 10 * i, 115 - 10 * i, 95 - 10 * i, values[i]);
  test::add_surface(p, 55, 45, 58, 48, 9000);
  BlobFinder find{k_settings};
  find.settings.max_area_px = 400;
  find(p);
  ASSERT_EQ(find.blobs->count, 1);
  EXPECT_EQ(find.blobs->items[0].area_px, 9u);
  EXPECT_EQ(find.blobs->items[0].peak, 9000);
}

TEST(Rescan, KeepsTheFirstRunsAndReportsMore) {
  const TestImage p = marker_on_surface(40, 30);
  BlobFinder whole{k_settings};
  const BlobWork needed = whole(p);
  ASSERT_EQ(whole.blobs->count, 1);
  Runs& runs = *whole.runs;
  for (const int less : {0, 1, 3}) {
    const Frame frame = p.frame();
    const Runs* bands[] = {&runs};
    find_components(bands, *whole.scratch);
    const Rescan rescan = rescan_oversized(frame, 100, needed.runs - less, 10'000, *whole.scratch);
    EXPECT_EQ(rescan.reason, less == 0 ? Reason::none : Reason::runs_full) << less;
    EXPECT_EQ(whole.scratch->run_count, needed.runs - less);
    EXPECT_EQ(whole.scratch->component_count, 2) << less;
  }
}

// The surface has 54 runs, the marker on it 7; four bands of 15 runs may have 60.
TEST(Rescan, SharesTheRunsOfAllBands) {
  const TestImage p = marker_on_surface(40.5, 30.5);
  auto runs = std::make_unique<Runs>();
  threshold_runs(p.frame(), whole_frame(p.frame()), 40, {}, *runs);
  ASSERT_EQ(runs->count, 54);
  for (const bool fits : {false, true}) {
    BlobFinder find{k_settings};
    find.limits.runs_per_band = fits ? 16 : 15;
    std::array<Runs, 4> parts;
    std::array<const Runs*, 4> bands;
    for (int i = 0; i < runs->count; ++i) {
      Runs& part = parts[static_cast<std::size_t>(i / 14)];
      part.items[static_cast<std::size_t>(part.count++)] = runs->items[static_cast<std::size_t>(i)];
    }
    for (std::size_t i = 0; i < 4; ++i) bands[i] = &parts[i];
    const BlobWork work =
        find_blobs(p.frame(), bands, find.settings, {}, *find.scratch, *find.blobs, find.limits);
    EXPECT_EQ(work.runs, fits ? 61 : 60);
    EXPECT_EQ(find.blobs->incomplete, fits ? Reason::none : Reason::runs_full);
    EXPECT_EQ(find.blobs->reason, fits ? Reason::none : Reason::runs_full);
  }
}

TEST(Rescan, ScansAtMostTheBlocksOfAFrame) {
  TestImage p(96, 64, 60);
  test::add_disc(p, 40, 60, 3, 120);
  BlobFinder find{k_settings};
  find.limits.width = p.width;
  find.limits.height = p.height;
  EXPECT_EQ(rescan_blocks_max(find.limits), 3 * 64);
  EXPECT_EQ(find(p).rescans, 3 * 64);
  EXPECT_EQ(find.blobs->incomplete, Reason::none);
  EXPECT_EQ(find.blobs->count, 1);
  const Frame frame = p.frame();
  const Runs* bands[] = {find.runs.get()};
  find_components(bands, *find.scratch);
  const Rescan rescan = rescan_oversized(frame, 100, k_runs_max, 3 * 64 - 1, *find.scratch);
  EXPECT_EQ(rescan.blocks, 3 * 64 - 1);
  EXPECT_EQ(rescan.reason, Reason::runs_full);
}

}  // namespace
}  // namespace glint::rescan_test
