#include "kernels/image/marker_misfit.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "tests/unit/kernels/image/picture_of.hpp"

namespace glint::marker_misfit_test {
namespace {

constexpr double k_focal_px = 253, k_radius_m = 0.0055;

// A component in a frame whose pixels all have one level and one depth.
struct Scene {
  std::vector<std::uint16_t> level = std::vector<std::uint16_t>(64 * 64, 20'000);
  std::vector<std::uint16_t> depth = std::vector<std::uint16_t>(64 * 64, 500);
  Component component;
  BlobSettings settings{1, 4096, 1280, 0xFFFF};

  Scene() {
    settings.sizes =
        marker_sizes({k_radius_m, k_radius_m, 0.8, k_focal_px, 0.15, 1.0, 0.001, 4090});
    of(24, 6, 6);  // a ball of 11 mm at half a metre: 24 pixels
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
  scene.of(45, 8, 8);  // by its halo
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
  scene.of(6, 3, 2);  // at a metre a marker has so many
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
  scene.depth[at(21, 20)] = 0;  // the middle
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
