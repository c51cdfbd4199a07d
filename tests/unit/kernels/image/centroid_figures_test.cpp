// Every field of a centroid against its definition, and the fall-back of the grown centroid to the
// plain mean.
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <utility>

#include "kernels/image/centroid.hpp"
#include "kernels/image/components.hpp"
#include "kernels/image/roi_threshold.hpp"
#include "tests/unit/kernels/image/test_image.hpp"

namespace glint::centroid_figures_test {
namespace {

using test::TestImage;

constexpr std::uint16_t k_threshold = 1280;

// First component of the image.
struct Found {
  std::unique_ptr<BlobScratch> scratch = std::make_unique<BlobScratch>();

  explicit Found(const Frame& frame, std::uint16_t threshold = k_threshold) {
    auto runs = std::make_unique<Runs>();
    threshold_runs(frame, whole_frame(frame), threshold, {}, *runs);
    const Runs* bands[] = {runs.get()};
    find_components(bands, *scratch);
  }
  [[nodiscard]] const Component& component() const { return scratch->components[0]; }
};

Centroid grown(const TestImage& picture, std::uint16_t threshold = k_threshold) {
  const Frame frame = picture.frame();
  const Found found(frame, threshold);
  return grown_centroid(frame, *found.scratch, found.component(), threshold);
}

// Returns whether a pixel is within `reach` of a bright one. All bright pixels belong to one blob.
bool is_near(TestImage& p, int x, int y, int reach) {
  for (int dy = -reach; dy <= reach; ++dy) {
    for (int dx = -reach; dx <= reach; ++dx) {
      const bool inside = x + dx >= 0 && x + dx < p.width && y + dy >= 0 && y + dy < p.height;
      if (inside && p(x + dx, y + dy) > k_threshold) return true;
    }
  }
  return false;
}

Centroid grown_by_definition(TestImage& p) {
  Centroid out;
  double dark = 0;
  for (int i = 0; i < p.width * p.height; ++i) {
    const int x = i % p.width, y = i / p.width;
    if (is_near(p, x, y, 1) || !is_near(p, x, y, 2)) continue;
    dark += p(x, y);
    ++out.dark_pixels;
  }
  out.background = dark / out.dark_pixels;
  Vector2 sum = Vector2::Zero(), middle = Vector2::Zero();
  for (int i = 0; i < p.width * p.height; ++i) {
    const int x = i % p.width, y = i / p.width;
    if (!is_near(p, x, y, 1)) continue;
    out.peak = std::max(out.peak, p(x, y));
    ++out.pixels;
    out.intensity_sum += p(x, y) - out.background;
    sum += (p(x, y) - out.background) * Vector2(x + 0.5, y + 0.5);
    middle += Vector2(x + 0.5, y + 0.5);
  }
  out.position_px = sum / out.intensity_sum;
  out.lever_px = middle - out.pixels * out.position_px;
  return out;
}

void expect_near(const Centroid& found, const Centroid& expected) {
  EXPECT_LT((found.position_px - expected.position_px).norm(), 1e-9);
  EXPECT_EQ(found.peak, expected.peak);
  EXPECT_FALSE(found.has_bright_rim);
  EXPECT_NEAR(found.intensity_sum, expected.intensity_sum, 1e-9 * expected.intensity_sum);
  EXPECT_NEAR(found.background, expected.background, 1e-9 * expected.background);
  EXPECT_EQ(found.pixels, expected.pixels);
  EXPECT_EQ(found.dark_pixels, expected.dark_pixels);
  EXPECT_LT((found.lever_px - expected.lever_px).norm(), 1e-6);
}

TEST(CentroidFigures, OfAGrownBlobAreThoseOfTheDefinition) {
  std::mt19937 random(14);
  for (int round = 0; round < 100; ++round) {
    const auto below = [&](unsigned n) { return static_cast<int>(random() % n); };
    TestImage p(20 + below(60), 20 + below(30));
    for (auto& value : p.pixels_16) value = static_cast<std::uint16_t>(200 + random() % 300);
    const int x0 = below(static_cast<unsigned>(p.width - 3)),
              y0 = below(static_cast<unsigned>(p.height - 3));
    const int x1 = std::min(x0 + 2 + below(15), p.width),
              y1 = std::min(y0 + 2 + below(9), p.height);
    for (int y = y0; y < y1; ++y)
      for (int x = x0; x < x1; ++x) p(x, y) = static_cast<std::uint16_t>(5000 + random() % 3000);
    expect_near(grown(p), grown_by_definition(p));
    ASSERT_FALSE(HasFailure()) << "round " << round;
  }
}

// Boxes of the maximum width, in frames whose width is below, at and above the box's 64 columns.
TEST(CentroidFigures, OfTheWidestBoxesAreThoseOfTheDefinitionAtEitherBorder) {
  std::mt19937 random(15);
  for (int width = 60; width <= 68; ++width) {
    for (int side = 56; side <= std::min(width, k_grown_box_max); ++side) {
      for (const int x0 : {0, (width - side) / 2, width - side}) {
        TestImage p(width, 9);
        for (auto& value : p.pixels_16) value = static_cast<std::uint16_t>(200 + random() % 300);
        for (int x = x0; x < x0 + side; ++x)
          p(x, 4) = static_cast<std::uint16_t>(5000 + random() % 3000);
        expect_near(grown(p), grown_by_definition(p));
        ASSERT_FALSE(HasFailure()) << side << " of " << width << " from " << x0;
      }
    }
  }
}

// A dark pixel beside the blob shifts the centroid. Up to the box's border the grown centroid is
// used, beyond it the plain mean.
TEST(CentroidFigures, FallBackWhereTheMiddleLeavesTheBoxOnAnySide) {
  for (const auto& [dx, dy] : {std::pair{-1, 0}, {1, 0}, {0, -1}, {0, 1}}) {
    for (const int contrast : {2, 3, 4}) {
      TestImage p(9, 9, 1280);
      p(4, 4) = static_cast<std::uint16_t>(1280 + contrast);
      p(4 + dx, 4 + dy) = 1279;
      const Centroid found = grown(p);
      // (contrast * centre - 1 * neighbour) / (contrast - 1): 1 / (contrast - 1) away from the
      // centre.
      const Vector2 off = Vector2(-dx, -dy) / (contrast - 1);
      const bool inside = contrast > 2;
      EXPECT_LT((found.position_px - Vector2(4.5, 4.5) - (inside ? off : Vector2(0, 0))).norm(),
                1e-12)
          << dx << dy << contrast;
      EXPECT_EQ(found.pixels, inside ? 9 : 0);
      EXPECT_EQ(found.dark_pixels, inside ? 16 : 0);
      EXPECT_EQ(found.intensity_sum, inside ? contrast - 1 : 0);
      EXPECT_EQ(found.background, inside ? 1280 : 0);
      EXPECT_EQ(found.peak, 1280 + contrast);
    }
  }
}

// The sum of weights is zero, and slightly negative.
TEST(CentroidFigures, FallBackWhereTheBlobIsNoBrighterThanItsSurroundings) {
  for (const int darker : {1279, 1278}) {
    TestImage p(9, 9, 1280);
    p(4, 4) = 1281;
    p(3, 3) = static_cast<std::uint16_t>(darker);
    const Centroid found = grown(p);
    EXPECT_EQ(found.position_px, Vector2(4.5, 4.5));
    EXPECT_EQ(found.pixels, 0);
    EXPECT_EQ(found.peak, 1281);
  }
}

TEST(CentroidFigures, KeepPeakAndNeighbourWhereTheyFallBack) {
  TestImage p(16, 9, 1280);
  p(4, 4) = 1281;
  p(3, 3) = 0;
  p(6, 4) = 1290;  // another blob, two pixels away
  const Centroid found = grown(p);
  EXPECT_EQ(found.pixels, 0);
  EXPECT_TRUE(found.has_bright_rim);
  EXPECT_EQ(found.peak, 1281);
}

TEST(CentroidFigures, OfTheWeightedMeanAreThoseOfItsDefinition) {
  std::mt19937 random(16);
  for (int round = 0; round < 60; ++round) {
    TestImage p(30, 20);
    for (int y = 5; y < 9; ++y)
      for (int x = 7; x < 7 + 3 + round % 5; ++x)
        p(x, y) = static_cast<std::uint16_t>(201 + random() % (round % 2 == 0 ? 3 : 50));
    for (const bool narrow : {false, true}) {
      const TestImage seen = narrow ? p.with_8_bits() : p;
      const Frame frame = seen.frame();
      const Found found(frame, 200);
      const Centroid centroid = weighted_centroid(frame, *found.scratch, found.component(), 200);
      double weights = 0;
      Vector2 sum = Vector2::Zero();
      int peak = 0;
      for (int y = 0; y < p.height; ++y) {
        for (int x = 0; x < p.width; ++x) {
          const int value = narrow ? seen.pixels_8[seen.at(x, y)] : p(x, y);
          if (value <= 200) continue;
          weights += value - 200;
          sum += (value - 200) * Vector2(x + 0.5, y + 0.5);
          peak = std::max(peak, value);
        }
      }
      EXPECT_LT((centroid.position_px - sum / weights).norm(), 1e-12) << round;
      EXPECT_EQ(centroid.peak, peak);
      EXPECT_EQ(centroid.pixels, 0) << "no figures of a grown blob";
    }
  }
}

// The threshold equals the blob's level or is above it.
TEST(CentroidFigures, OfTheWeightedMeanAreNoneWithoutWeight) {
  TestImage p(9, 9);
  p(3, 3) = p(4, 3) = 1000;
  const Frame frame = p.frame();
  const Found found(frame, 500);
  for (const std::uint16_t threshold : {1000, 1001}) {
    const Centroid none = weighted_centroid(frame, *found.scratch, found.component(), threshold);
    EXPECT_EQ(none.position_px, Vector2(0, 0));
    EXPECT_EQ(none.peak, 0);
  }
  EXPECT_EQ(weighted_centroid(frame, *found.scratch, found.component(), 999).position_px,
            Vector2(4, 3.5));
}

// The peak of a run is searched at its ends and its centre.
TEST(CentroidFigures, OfThePlainMeanAreTheMeanAndTheBrightestOfEachRunsEndsAndMiddle) {
  for (const int brightest : {0, 1, 2, 3, 4, 5, 6, 7, 8}) {
    TestImage p(40, 20);
    for (int x = 0; x < 9; ++x) p(10 + x, 6) = 600;
    for (int x = 0; x < 4; ++x) p(12 + x, 7) = 601;
    p(10 + brightest, 6) = 900;
    const Frame frame = p.frame();
    const Found found(frame, 500);
    const Centroid plain = binary_centroid(frame, *found.scratch, found.component());
    EXPECT_DOUBLE_EQ(plain.position_px.x(), (9 * 14.5 + 4 * 14) / 13);
    EXPECT_DOUBLE_EQ(plain.position_px.y(), (9 * 6.5 + 4 * 7.5) / 13);
    const bool seen = brightest == 0 || brightest == 4 || brightest == 8;
    EXPECT_EQ(plain.peak, seen ? 900 : 601) << brightest;
    EXPECT_EQ(plain.pixels, 0);
  }
}

TEST(CentroidFigures, OfThePlainMeanAreTheSameFromEightBits) {
  TestImage p(40, 20);
  for (int x = 0; x < 9; ++x) p(10 + x, 6) = static_cast<std::uint16_t>(100 + 10 * x);
  const TestImage narrow = p.with_8_bits();
  const Found a(p.frame(), 50), b(narrow.frame(), 50);
  const Centroid wide = binary_centroid(p.frame(), *a.scratch, a.component());
  const Centroid small = binary_centroid(narrow.frame(), *b.scratch, b.component());
  EXPECT_EQ(small.position_px, wide.position_px);
  EXPECT_EQ(small.peak, 180);
  EXPECT_EQ(wide.peak, 180);
}

// A box that is too large along one axis only.
TEST(CentroidFigures, OfATallOrWideBoxAreThePlainMeans) {
  for (const bool tall : {false, true}) {
    TestImage p(100, 100, 100);
    for (int i = 0; i <= k_grown_box_max; ++i)
      (tall ? p(20, 10 + i) : p(10 + i, 20)) = static_cast<std::uint16_t>(2000 + 50 * i);
    const double middle = 10 + 0.5 * (k_grown_box_max + 1);
    EXPECT_EQ(grown(p).position_px, tall ? Vector2(20.5, middle) : Vector2(middle, 20.5));
  }
}

}  // namespace
}  // namespace glint::centroid_figures_test
