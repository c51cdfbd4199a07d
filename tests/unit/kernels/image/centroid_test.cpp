#include "kernels/image/centroid.hpp"

#include <gtest/gtest.h>

#include <memory>

#include "kernels/image/components.hpp"
#include "kernels/image/roi_threshold.hpp"
#include "tests/unit/kernels/image/test_image.hpp"

namespace glint::centroid_test {
namespace {

using test::TestImage;

constexpr std::uint16_t k_threshold = 1280;

// First component of the image.
struct Found {
  std::unique_ptr<BlobScratch> scratch = std::make_unique<BlobScratch>();
  const Component& component() const { return scratch->components[0]; }

  explicit Found(const Frame& frame, std::uint16_t threshold = k_threshold) {
    auto runs = std::make_unique<Runs>();
    threshold_runs(frame, whole_frame(frame), threshold, {}, *runs);
    const Runs* bands[] = {runs.get()};
    find_components(bands, *scratch);
  }
};

struct Errors {
  double grown = 0, weighted = 0, binary = 0;  // rms an axis, pixels
};

// Errors for discs at random positions on a uniform background with little noise.
Errors errors_of(double diameter, double brightness, int rounds) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> part(0, 1);
  Errors sum;
  for (int i = 0; i < rounds; ++i) {
    TestImage p(40, 40);
    for (auto& value : p.pixels_16) value = static_cast<std::uint16_t>(200 + random() % 20);
    const Vector2 truth{18 + part(random), 18 + part(random)};
    test::add_disc(p, truth.x(), truth.y(), diameter / 2, brightness);
    const Frame frame = p.frame();
    const Found found(frame);
    const auto square = [&](const Centroid& c) {
      return (c.position_px - truth).squaredNorm() / 2;
    };
    sum.grown += square(grown_centroid(frame, *found.scratch, found.component(), k_threshold));
    sum.weighted +=
        square(weighted_centroid(frame, *found.scratch, found.component(), k_threshold));
    sum.binary += square(binary_centroid(frame, *found.scratch, found.component()));
  }
  return {std::sqrt(sum.grown / rounds), std::sqrt(sum.weighted / rounds),
          std::sqrt(sum.binary / rounds)};
}

TEST(Centroids, OfDiscsAreGoodToThreeHundredthsOfAPixel) {
  for (const double diameter : {4.0, 5.0, 6.0, 8.0, 10.0}) {
    const Errors errors = errors_of(diameter, 8000, 100);
    EXPECT_LT(errors.grown, 0.03) << diameter;
    EXPECT_LT(errors.grown, 0.7 * errors.weighted) << diameter;
    EXPECT_LT(errors.weighted, errors.binary) << diameter;
    RecordProperty("grown_rms_px_" + std::to_string(static_cast<int>(diameter)),
                   std::to_string(errors.grown));
  }
}

TEST(Centroids, OfASymmetricBlobAreItsMiddleExactly) {
  TestImage p(9, 9, 100);
  for (int y = 3; y < 6; ++y) {
    for (int x = 2; x < 7; ++x) p(x, y) = 3000;
  }
  const Frame frame = p.frame();
  const Found found(frame);
  EXPECT_EQ(grown_centroid(frame, *found.scratch, found.component(), k_threshold).position_px,
            Vector2(4.5, 4.5));
  EXPECT_EQ(binary_centroid(frame, *found.scratch, found.component()).position_px,
            Vector2(4.5, 4.5));
}

// The background changes, the blob does not.
TEST(Centroids, DoNotMoveWithTheBackground) {
  std::vector<Vector2> positions;
  for (const std::uint16_t background : {0, 500, 1000}) {
    TestImage p(30, 30, background);
    test::add_disc(p, 14.3, 15.8, 3, 9000);
    const Frame frame = p.frame();
    const Found found(frame);
    positions.push_back(
        grown_centroid(frame, *found.scratch, found.component(), k_threshold).position_px);
  }
  EXPECT_LT((positions[1] - positions[0]).norm(), 1e-3);
  EXPECT_LT((positions[2] - positions[0]).norm(), 1e-3);
}

TEST(Centroids, MoveByTheSameWholePixelsAsTheDisc) {
  Vector2 first = Vector2::Zero();
  for (int shift = 0; shift < 5; ++shift) {
    TestImage p(40, 40, 150);
    test::add_disc(p, 12.25 + shift, 13.75 + 2 * shift, 3.5, 9000);
    const Frame frame = p.frame();
    const Found found(frame);
    const Vector2 at =
        grown_centroid(frame, *found.scratch, found.component(), k_threshold).position_px;
    if (shift == 0) first = at;
    EXPECT_LT((at - first - Vector2(shift, 2 * shift)).norm(), 1e-12);
  }
}

TEST(Centroids, StayInsideTheFrameAtItsCorners) {
  for (const Vector2& corner : {Vector2(0, 0), Vector2(20, 0), Vector2(0, 20), Vector2(20, 20)}) {
    TestImage p(20, 20, 150);
    test::add_disc(p, corner.x(), corner.y(), 3.5, 9000);
    const Frame frame = p.frame();
    const Found found(frame);
    const Vector2 at =
        grown_centroid(frame, *found.scratch, found.component(), k_threshold).position_px;
    EXPECT_LT((at - corner).norm(), 3.5);
    EXPECT_TRUE(at.x() > 0 && at.y() > 0 && at.x() < 20 && at.y() < 20);
  }
}

TEST(Centroids, OfALargeBoxAreThePlainMean) {
  TestImage wide(200, 20, 0);
  for (int x = 10; x < 110; ++x) wide(x, 7) = static_cast<std::uint16_t>(2000 + 50 * x);
  const Frame frame = wide.frame();
  const Found found(frame);
  const Centroid grown = grown_centroid(frame, *found.scratch, found.component(), k_threshold);
  EXPECT_EQ(grown.position_px, Vector2(60, 7.5));
  EXPECT_EQ(grown.peak, 2000 + 50 * 109);
}

TEST(Centroids, OfTheLargestGrownBoxAreRight) {
  TestImage p(66, 66, 0);
  for (int y = 3; y < 3 + k_grown_box_max; ++y) {
    for (int x = 3; x < 3 + k_grown_box_max; ++x) p(x, y) = 0xFFFF;
  }
  const Frame frame = p.frame();
  const Found found(frame);
  EXPECT_EQ(grown_centroid(frame, *found.scratch, found.component(), k_threshold).position_px,
            Vector2(33, 33));
}

// The definition, pixel by pixel. All bright pixels belong to one blob.
Vector2 plain_grown_centroid(TestImage& p) {
  const auto near = [&](int x, int y, int reach) {
    for (int dy = -reach; dy <= reach; ++dy) {
      for (int dx = -reach; dx <= reach; ++dx) {
        const bool inside = x + dx >= 0 && x + dx < p.width && y + dy >= 0 && y + dy < p.height;
        if (inside && p(x + dx, y + dy) > k_threshold) return true;
      }
    }
    return false;
  };
  double dark = 0, dark_pixels = 0;
  for (int i = 0; i < p.width * p.height; ++i) {
    const int x = i % p.width, y = i / p.width;
    if (near(x, y, 1) || !near(x, y, 2)) continue;
    dark += p(x, y);
    dark_pixels += 1;
  }
  double weights = 0;
  Vector2 sum = Vector2::Zero();
  for (int i = 0; i < p.width * p.height; ++i) {
    const int x = i % p.width, y = i / p.width;
    if (!near(x, y, 1)) continue;
    const double weight = p(x, y) - dark / std::max(dark_pixels, 1.0);
    weights += weight;
    sum += weight * Vector2(x + 0.5, y + 0.5);
  }
  return sum / weights;
}

TEST(Centroids, AreThoseOfTheDefinitionInFramesOfAnyWidth) {
  std::mt19937 random(4);
  for (int round = 0; round < 200; ++round) {
    const auto below = [&](unsigned n) { return static_cast<int>(random() % n); };
    TestImage p(6 + below(80), 6 + below(40));
    for (auto& value : p.pixels_16) value = static_cast<std::uint16_t>(200 + random() % 300);
    const int x0 = below(static_cast<unsigned>(p.width - 3)),
              y0 = below(static_cast<unsigned>(p.height - 3));
    const int x1 = std::min(x0 + 2 + below(40), p.width),
              y1 = std::min(y0 + 2 + below(20), p.height);
    for (int y = y0; y < y1; ++y) {
      for (int x = x0; x < x1; ++x) p(x, y) = static_cast<std::uint16_t>(5000 + random() % 3000);
    }
    const Frame frame = p.frame();
    const Found found(frame);
    const Vector2 at =
        grown_centroid(frame, *found.scratch, found.component(), k_threshold).position_px;
    ASSERT_LT((at - plain_grown_centroid(p)).norm(), 1e-9) << "round " << round;
  }
}

// The surroundings are as bright as the blob: the sum of weights is zero.
TEST(Centroids, FallBackToThePlainMeanWithoutContrast) {
  TestImage p(9, 9, 1280);
  p(4, 4) = 1281;
  p(3, 3) = 0;
  p(3, 4) = 0;
  p(3, 5) = 0;
  const Frame frame = p.frame();
  const Found found(frame);
  const Vector2 at =
      grown_centroid(frame, *found.scratch, found.component(), k_threshold).position_px;
  EXPECT_EQ(at, Vector2(4.5, 4.5));
}

TEST(Centroids, AreTheSameFromEightAndFromSixteenBits) {
  TestImage p(30, 30, 20);
  test::add_disc(p, 14.3, 15.8, 3, 200);
  const TestImage narrow = p.with_8_bits();
  const Frame wide_frame = p.frame(), narrow_frame = narrow.frame();
  const Found a(wide_frame, 100), b(narrow_frame, 100);
  EXPECT_EQ(grown_centroid(wide_frame, *a.scratch, a.component(), 100).position_px,
            grown_centroid(narrow_frame, *b.scratch, b.component(), 100).position_px);
}

}  // namespace
}  // namespace glint::centroid_test
