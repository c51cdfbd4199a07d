#include "kernels/image/marker_misfit.hpp"

#include <gtest/gtest.h>

#include <array>
#include <utility>
#include <vector>

#include "tests/unit/kernels/image/test_image.hpp"

namespace glint::marker_misfit_test {
namespace {

constexpr double k_focal_px = 253, k_radius_m = 0.0055;

// A component in a frame of uniform level and uniform depth.
struct Scene {
  std::vector<std::uint16_t> level = std::vector<std::uint16_t>(64 * 64, 20'000);
  std::vector<std::uint16_t> depth = std::vector<std::uint16_t>(64 * 64, 500);
  Component component;
  BlobSettings settings{1, 4096, 1280, 0xFFFF};

  Scene() {
    settings.sizes =
        marker_sizes({k_radius_m, k_radius_m, 0.8, k_focal_px, 0.15, 1.0, 0.001, 4090});
    of(24, 6, 6);  // a ball of 11 mm at 0.5 m: 24 pixels
  }
  void of(std::uint32_t area_px, int width, int height) {
    component.area_px = area_px;
    component.x0 = component.y0 = 20;
    component.x1 = static_cast<std::uint16_t>(20 + width);
    component.y1 = static_cast<std::uint16_t>(20 + height);
  }
  [[nodiscard]] int misfit() const {
    Frame frame;
    frame.reflectivity_16 = {level.data(), 64, 64};
    frame.depth = {depth.data(), 64, 64};
    return marker_misfit(frame, component, settings);
  }
};

TEST(MarkerMisfit, IsNoneOfAWholeMarker) {
  Scene scene;
  EXPECT_EQ(scene.misfit(), 0);
  scene.of(45, 8, 8);  // with its halo
  EXPECT_EQ(scene.misfit(), 0);
}

TEST(MarkerMisfit, GrowsWithEachFactorOfTwoInSize) {
  Scene scene;
  int last = 0;
  for (const unsigned area : {12u, 6u, 3u}) {
    scene.of(area, 4, static_cast<int>(area + 3) / 4);
    EXPECT_GT(scene.misfit(), last) << area;
    last = scene.misfit();
  }
  for (const unsigned side : {10u, 14u, 20u}) {
    scene.of(side * side, static_cast<int>(side), static_cast<int>(side));
    EXPECT_EQ(scene.misfit(), side == 10 ? 1 : side == 14 ? 2 : 3) << side;
  }
}

TEST(MarkerMisfit, ComparesWithTheSizeAtItsOwnDepth) {
  Scene scene;
  scene.of(6, 3, 2);  // area of a marker at 1 m
  EXPECT_GE(scene.misfit(), 2);
  scene.depth.assign(scene.depth.size(), 980);
  EXPECT_EQ(scene.misfit(), 0);
}

TEST(MarkerMisfit, OfASinglePixelIsTwoStepsOrMoreAtAnyRange) {
  Scene scene;
  scene.of(1, 1, 1);
  for (std::uint16_t depth = 0; depth < 5000; depth = static_cast<std::uint16_t>(depth + 10)) {
    scene.depth.assign(scene.depth.size(), depth);
    EXPECT_GE(scene.misfit(), 2) << depth << " mm";
  }
}

TEST(MarkerMisfit, TakesTheRimsDepthWhereTheMiddleIsSaturated) {
  Scene scene;
  scene.of(6, 3, 2);
  const auto at = [](int x, int y) { return static_cast<std::size_t>(64 * y + x); };
  scene.depth.assign(scene.depth.size(), 980);
  scene.depth[at(21, 20)] = 0;  // the centre
  EXPECT_EQ(scene.misfit(), 0);
  scene.of(24, 6, 6);
  scene.depth.assign(scene.depth.size(), 0);
  EXPECT_EQ(scene.misfit(), 0) << "no depth at all: as large as at some range";
}

TEST(MarkerMisfit, CountsAShapeThatIsNoDiscs) {
  Scene scene;
  scene.of(24, 12, 2);
  EXPECT_EQ(scene.misfit(), 1) << "long";
  scene.of(24, 8, 8);
  EXPECT_EQ(scene.misfit(), 1) << "thin";
}

TEST(MarkerMisfit, CountsLittleContrast) {
  Scene scene;
  scene.level.assign(scene.level.size(), 2 * 1280 - 1);
  EXPECT_EQ(scene.misfit(), 1);
  scene.level.assign(scene.level.size(), 2 * 1280);
  EXPECT_EQ(scene.misfit(), 0);
}

TEST(MarkerMisfit, NeverExceedsItsMaximumAndIgnoresUnknownSizes) {
  Scene scene;
  scene.of(1, 64 - 20, 1);
  scene.level.assign(scene.level.size(), 0);
  EXPECT_EQ(scene.misfit(), k_misfit_max);
  scene.settings.sizes = marker_sizes({});
  EXPECT_FALSE(scene.settings.sizes.known) << "no focal length";
  EXPECT_EQ(scene.misfit(), 2) << "shape and contrast";
}

// Exact area limits: 16 to 64 pixels in this depth bin, 1 to 4096 in all others.
MarkerSizes sizes_at(int bin) {
  MarkerSizes sizes;
  sizes.known = true;
  sizes.depth_shift = 4;
  sizes.invalid_from = 3000;
  sizes.without_depth = {1, 4096};
  sizes.by_depth.fill({1, 4096});
  sizes.by_depth[static_cast<std::size_t>(bin)] = {16, 64};
  return sizes;
}

TEST(MarkerMisfit, IsAStepForEachFactorOfTwoBeyondTheSizesUpToThree) {
  Scene scene;
  scene.settings.sizes = sizes_at(500 >> 4);
  const std::pair<unsigned, int> expected[] = {{16, 0},  {15, 1},  {8, 1},   {7, 2},   {4, 2},
                                               {3, 3},   {1, 3},   {64, 0},  {65, 1},  {128, 1},
                                               {129, 2}, {256, 2}, {257, 3}, {4000, 3}};
  for (const auto& [area, steps] : expected) {
    scene.of(area, 1, 1);  // no shape criterion
    EXPECT_EQ(scene.misfit(), steps) << area;
  }
}

// Depth is the first valid one of five pixels: centre, left, right, top, bottom.
TEST(MarkerMisfit, TakesTheFirstDepthOfMiddleLeftRightTopAndBottom) {
  const std::array<std::pair<int, int>, 5> places = {
      {{22, 23}, {20, 23}, {25, 23}, {22, 20}, {22, 26}}};
  Scene scene;
  scene.settings.sizes = sizes_at(500 >> 4);
  scene.of(8, 6, 7);  // one step too small at that depth, and too small a share of its box
  const auto at = [](const std::pair<int, int>& place) {
    return static_cast<std::size_t>(64 * place.second + place.first);
  };
  for (const std::uint16_t none : {0, 3000, 0xFFFF}) {
    scene.depth.assign(scene.depth.size(), none);
    EXPECT_EQ(scene.misfit(), 1) << "no depth at all";
    for (std::size_t first = 0; first < places.size(); ++first) {
      scene.depth.assign(scene.depth.size(), none);
      scene.depth[at(places[first])] = 500;
      EXPECT_EQ(scene.misfit(), 2) << first;
      // A later depth with another value is ignored; an earlier one is used, however small.
      for (std::size_t later = first + 1; later < places.size(); ++later)
        scene.depth[at(places[later])] = 1;
      EXPECT_EQ(scene.misfit(), 2) << first;
      for (const std::uint16_t other : {1, 2999}) {
        if (first == 0) continue;
        scene.depth[at(places[first - 1])] = other;
        EXPECT_EQ(scene.misfit(), 1) << first << " " << other;
      }
    }
  }
}

TEST(MarkerMisfit, ComparesWithTheLastSizesBeyondTheirDepths) {
  Scene scene;
  scene.settings.sizes = sizes_at(k_depth_bins - 1);
  scene.of(8, 1, 1);
  for (const auto& [raw, steps] :
       {std::pair{2031, 0}, {2032, 1}, {2047, 1}, {2048, 1}, {2999, 1}}) {
    scene.depth.assign(scene.depth.size(), static_cast<std::uint16_t>(raw));
    EXPECT_EQ(scene.misfit(), steps) << raw;
  }
}

TEST(MarkerMisfit, IsThatWithoutDepthWhereTheFrameHasNone) {
  Scene scene;
  scene.settings.sizes = sizes_at(500 >> 4);
  scene.settings.sizes.without_depth = {100, 200};
  scene.of(24, 6, 6);
  Frame frame;
  frame.reflectivity_16 = {scene.level.data(), 64, 64};
  EXPECT_EQ(marker_misfit(frame, scene.component, scene.settings), 3);
  EXPECT_EQ(scene.misfit(), 0);
}

// A box that is half full, and one pixel less.
TEST(MarkerMisfit, CountsABoxThatIsLessThanHalfFull) {
  Scene scene;
  scene.settings.sizes.known = false;
  scene.of(18, 6, 6);
  EXPECT_EQ(scene.misfit(), 0);
  scene.of(17, 6, 6);
  EXPECT_EQ(scene.misfit(), 1);
}

// Contrast is the level of the centre pixel alone, for 16-bit and for 8-bit frames.
TEST(MarkerMisfit, ReadsTheContrastInTheMiddle) {
  for (const bool low_contrast : {false, true}) {
    Scene scene;
    scene.settings.sizes.known = false;
    scene.settings.threshold = 100;
    scene.of(40, 6, 7);  // centre: column 22, row 23
    const std::uint16_t middle = low_contrast ? 199 : 200, around = low_contrast ? 200 : 199;
    scene.level.assign(scene.level.size(), around);
    scene.level[static_cast<std::size_t>(64 * 23 + 22)] = middle;
    EXPECT_EQ(scene.misfit(), low_contrast ? 1 : 0);
    const std::vector<std::uint8_t> narrow(scene.level.begin(), scene.level.end());
    Frame frame;
    frame.reflectivity_8 = {narrow.data(), 64, 64};
    EXPECT_EQ(marker_misfit(frame, scene.component, scene.settings), low_contrast ? 1 : 0);
  }
}

TEST(MarkerMisfit, ComparesTheContrastWithTheComponentsOwnLevel) {
  for (const int middle : {299, 300}) {
    Scene scene;
    scene.settings.sizes.known = false;
    scene.settings.threshold = 100;
    scene.component.level = 150;
    scene.level.assign(scene.level.size(), static_cast<std::uint16_t>(middle));
    EXPECT_EQ(scene.misfit(), middle < 300 ? 1 : 0);
  }
}

TEST(MarkerSizes, HoldTheDiscAtEachDepth) {
  const MarkerSizes sizes = marker_sizes({0.004, 0.007, 0.8, k_focal_px, 0.15, 1.0, 0.001, 4090});
  ASSERT_TRUE(sizes.known);
  for (int raw = 150; raw <= 1000; ++raw) {
    const SizeGate& gate = sizes.by_depth[static_cast<std::size_t>(raw >> sizes.depth_shift)];
    const double small = 3.14159 * k_focal_px * k_focal_px * 0.004 * 0.004 / (raw * raw * 1e-6);
    EXPECT_LE(gate.min_area_px, std::ceil(0.8 * small)) << raw;
    EXPECT_GE(gate.min_area_px, 0.4 * small) << raw;
    EXPECT_GE(gate.max_area_px, 3.0 * small) << raw;
  }
  EXPECT_LT(4089 >> sizes.depth_shift, k_depth_bins);
  EXPECT_EQ(sizes.by_depth[k_depth_bins - 1].min_area_px, sizes.without_depth.min_area_px);
}

}  // namespace
}  // namespace glint::marker_misfit_test
