// Each term of a centroid's variance against its closed form, with the other terms subtracted.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>

#include "kernels/image/centroid_variance.hpp"

namespace glint::centroid_shares_test {
namespace {

// A blob with a box of 9 x 6 pixels and equal weights, over a background.
struct UniformBlob {
  Centroid centroid;
  Component component;
  BlobSettings settings{2, 4096, 300, 0xFFFF, {0, 0, 0}};

  UniformBlob() {
    centroid.peak = 2100;
    centroid.background = 100;
    centroid.intensity_sum = 40 * 2000.0;
    centroid.pixels = 75;
    centroid.dark_pixels = 41;
    centroid.lever_px = {30, -50};
    component.area_px = 50;
    component.x0 = 11;
    component.x1 = 20;
    component.y0 = 31;
    component.y1 = 37;
  }
  [[nodiscard]] double along(int axis) const {
    return centroid_variance(centroid, component, settings)[static_cast<std::size_t>(axis)];
  }
  [[nodiscard]] double size(int axis) const { return axis == 0 ? 9 : 6; }
};

// Variance from a pixel variance of `dark` in the background and `bright` in the sum of the light.
double noise_variance(const UniformBlob& blob, int axis, double dark, double bright) {
  const double own = std::pow(blob.size(axis) / 4, 2),
               grown = std::pow((blob.size(axis) + 2) / 4, 2);
  const double lever = blob.centroid.lever_px(axis);
  return (dark * (75 * grown + lever * lever / 41) + bright * own) / std::pow(40 * 2000.0, 2);
}

TEST(CentroidShares, OfEachKindOfNoiseAreItsOwn) {
  for (const int axis : {0, 1}) {
    const double quiet = UniformBlob{}.along(axis);
    UniformBlob read, shot, partially_occluded;
    read.settings.noise.read_counts = 700;
    shot.settings.noise.shot_counts = 3000;
    partially_occluded.settings.noise.proportional = 2;
    const double light = 40 * 2000.0;
    const auto expect_share = [&](const UniformBlob& blob, double dark, double bright) {
      const double share = noise_variance(blob, axis, dark, bright);
      ASSERT_GT(share, 3 * quiet) << "else rounding hides it";
      EXPECT_NEAR((blob.along(axis) - quiet) / share, 1, 1e-4) << axis;
    };
    expect_share(read, 700.0 * 700, 0);
    expect_share(shot, 3000.0 * 100, light * 3000);
    expect_share(partially_occluded, 4 * 100.0 * 100, light * 4 * 2000);
  }
}

TEST(CentroidShares, OfANeighbourIsThreePixelsBelowTheThresholdOnOneSide) {
  for (const int axis : {0, 1}) {
    UniformBlob blob;
    const double alone = blob.along(axis);
    blob.centroid.has_bright_rim = true;
    const double pulled = 3 * (300 - 100) * (0.5 * blob.size(axis) + 1) / (40 * 2000.0);
    EXPECT_NEAR((blob.along(axis) - alone) / (pulled * pulled), 1, 1e-4);
    blob.settings.threshold = 100;  // equal to the background: no light below the threshold
    const double level = blob.along(axis);
    blob.settings.threshold = 20;
    EXPECT_EQ(blob.along(axis), level);
    blob.centroid.has_bright_rim = false;
    EXPECT_EQ(blob.along(axis), level);
  }
}

constexpr double k_rim_miss = (1.0 / 120 - 1.0 / 144);  // half of four rim pixels, half an axis
constexpr double k_rim_clip = 0.63 / 24;
double diameter_of(double area_px) { return std::sqrt(4 * area_px / std::numbers::pi); }

// Area above the threshold of a blob with a rim of this width.
double area_with_rim(double lit_px, double width_px, double share) {
  return lit_px + 2 * diameter_of(lit_px) * width_px * (1 - 2 * share);
}

// Without noise: a rim of width r (at least 0.5 px) has the variance of a sharp rim divided by r^3.
TEST(CentroidShares, OfARimFallWithTheCubeOfItsWidth) {
  for (const double share : {0.0, 0.1, 0.2}) {
    for (const double width : {0.1, 0.3, 0.45, 0.6, 1.0, 1.5, 3.0}) {
      UniformBlob blob;
      // The area is rounded to whole pixels; `wide` is the rim width that it stands for.
      blob.component.area_px = static_cast<unsigned>(std::lround(area_with_rim(400, width, share)));
      blob.centroid.intensity_sum = 400 * 2000.0;
      blob.settings.threshold = static_cast<std::uint16_t>(100 + 2000 * share);
      const double wide =
          (blob.component.area_px - 400.0) / (2 * diameter_of(400) * (1 - 2 * share));
      const double seen = std::max(wide, 0.5);
      const double expected = k_rim_miss * diameter_of(400) / (seen * seen * seen * 400 * 400);
      EXPECT_NEAR(blob.along(0) / expected, 1, 1e-5) << share << " " << width;
      EXPECT_EQ(blob.along(0), blob.along(1));
    }
  }
}

// A clipped rim: the share of full pixels is at least a third and at most one.
TEST(CentroidShares, OfAClippedRimGrowWithThePartThatIsFull) {
  for (const double width : {-0.5, 0.0, 0.2, 0.5, 0.66, 0.7, 2.0}) {
    UniformBlob blob;
    blob.component.area_px = static_cast<unsigned>(std::lround(area_with_rim(400, width, 0.1)));
    blob.centroid.intensity_sum = 400 * 2000.0;
    blob.settings.saturated_from = 2100;
    const double wide = (blob.component.area_px - 400.0) / (2 * diameter_of(400) * 0.8);
    const double part = std::min(std::max(1 - wide, 1.0 / 3), 1.0);
    const double expected =
        k_rim_clip * part * part * std::pow(diameter_of(400), 3) / (400.0 * 400);
    EXPECT_NEAR(blob.along(0) / expected, 1, 1e-5) << width;
    blob.settings.saturated_from = 2101;
    EXPECT_LT(blob.along(0), 0.5 * expected) << "not clipped";
  }
}

// From a quarter of the signal on, the threshold leaves too little of the rim to measure. The rim
// then counts as one pixel wide, or as full if clipped.
TEST(CentroidShares, OfARimBelowAHighThresholdAreThoseOfOnePixel) {
  UniformBlob blob;
  blob.centroid.intensity_sum = 400 * 2000.0;
  blob.component.area_px = 900;
  blob.settings.threshold = 100 + 500;
  const double missed = k_rim_miss * diameter_of(400) / (400.0 * 400);
  EXPECT_NEAR(blob.along(0) / missed, 1, 1e-5);
  blob.settings.threshold = 100 + 499;
  EXPECT_LT(blob.along(0), 0.1 * missed) << "of a wide rim";
  blob.settings.threshold = 100 + 500;
  blob.settings.saturated_from = 2000;
  const double clipped = k_rim_clip * std::pow(diameter_of(400), 3) / (400.0 * 400);
  EXPECT_NEAR(blob.along(0) / clipped, 1, 1e-5);
}

// A signal below one count is set to one, an area below one pixel to one.
TEST(CentroidShares, HaveASignalAndAnAreaOfOneAtLeast) {
  UniformBlob blob;
  blob.centroid.peak = 100;
  blob.centroid.intensity_sum = 50;
  blob.settings.threshold = 100;
  blob.component.area_px = 60;
  const double wide = (60 - 50.0) / (2 * diameter_of(50));
  EXPECT_NEAR(
      blob.along(0) / (k_rim_miss * diameter_of(50) / (std::pow(std::max(wide, 0.5), 3) * 2500)), 1,
      1e-5);
  blob.centroid.intensity_sum = 0.25;
  blob.component.area_px = 1;
  EXPECT_NEAR(blob.along(0) / (k_rim_miss * diameter_of(1) * 8), 1, 1e-5);
}

// The variance of the plain mean is that of the component's area with a full rim.
TEST(CentroidShares, OfThePlainMeanIsThatOfItsAreaClipped) {
  UniformBlob blob;
  blob.centroid.pixels = 0;
  EXPECT_NEAR(blob.along(0) / (k_rim_clip * std::pow(diameter_of(50), 3) / 2500), 1, 1e-5);
  EXPECT_EQ(blob.along(0), blob.along(1));
}

TEST(CentroidShares, OfABoxThatIsUnevenBeginAtThreePixelsAndThreeQuarters) {
  const auto partially_occluded = [](int width, int height) {
    Component c;
    c.x0 = 3;
    c.y0 = 8;
    c.x1 = static_cast<std::uint16_t>(3 + width);
    c.y1 = static_cast<std::uint16_t>(8 + height);
    EXPECT_EQ(excess_px(c), std::abs(width - height));
    const auto shape = shape_variance(c, false, false);
    EXPECT_FLOAT_EQ(shape[0], 0.25F * static_cast<float>((width - height) * (width - height)));
    EXPECT_EQ(shape[1], shape[0]);
    return is_partial_or_merged(c);
  };
  for (const auto& [longer, shorter, expected] : {std::tuple{3, 1, false},
                                                  {4, 2, false},
                                                  {4, 1, true},
                                                  {5, 2, true},
                                                  {6, 3, true},
                                                  {7, 4, false},
                                                  {8, 4, true},
                                                  {14, 8, false},
                                                  {15, 8, true}}) {
    EXPECT_EQ(partially_occluded(longer, shorter), expected) << longer << " x " << shorter;
    EXPECT_EQ(partially_occluded(shorter, longer), expected) << shorter << " x " << longer;
  }
}

}  // namespace
}  // namespace glint::centroid_shares_test
