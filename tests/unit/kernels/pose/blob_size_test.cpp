#include "kernels/pose/blob_size.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <vector>

#include "tests/unit/kernels/pose/weighted_scene.hpp"

namespace glint::blob_size_test {
namespace {

using test::Random;

constexpr double k_focal_px = 253, k_range_m = 0.5;

struct Disc {
  Vector2 middle_px;
  double radius_px;
};

struct Drawn {
  std::uint32_t area_px = 0;
  Vector2 middle_px = Vector2::Zero();
};

// Pixels whose centre is inside one of the discs, up to `end_px` along x.
Drawn draw(const std::vector<Disc>& discs, double end_px = 64) {
  Drawn drawn;
  for (int y = 0; y < 64; ++y) {
    for (int x = 0; x < 64; ++x) {
      const Vector2 pixel(x + 0.5, y + 0.5);
      bool lit = false;
      for (const Disc& disc : discs) lit = lit || (pixel - disc.middle_px).norm() <= disc.radius_px;
      if (!lit || pixel.x() > end_px) continue;
      ++drawn.area_px;
      drawn.middle_px += pixel;
    }
  }
  drawn.middle_px /= drawn.area_px;
  return drawn;
}

Tool tool_of_radius(double radius_px, MarkerShape shape = MarkerShape::sphere) {
  Tool tool;
  tool.shape = shape;
  tool.marker_radius_m = radius_px * k_range_m / k_focal_px;
  return tool;
}

double rim_offset_of(std::uint32_t area_px, const Tool& tool, std::uint8_t flags = 0) {
  Marker marker;
  marker.area_px = area_px;
  marker.flags = flags;
  const LocalRays rays{Vector2::Zero(), Vector3::UnitZ(), Vector3::UnitX() / k_focal_px,
                       Vector3::UnitY() / k_focal_px};
  return rim_offset_px(marker, rays, tool, k_range_m);
}

// Variance of one axis that the blob's size adds.
double added_variance_px2(double own_rim_offset_px) {
  MarkerVariance variance{0, 0, 0, 1};
  inflate(variance, own_rim_offset_px);
  return variance.xx_px2;
}

Vector2 random_centre(Random& random) {
  const double x = random.within(0, 1), y = random.within(0, 1);
  return Vector2(32 + x, 32 + y);
}

TEST(BlobSize, SaysHardlyEverAnythingOfADiscOfItsOwn) {
  Random random(1);
  int flagged = 0;
  for (int trial = 0; trial < 2000; ++trial) {
    const double radius_px = random.within(1.5, 6);
    const Drawn drawn = draw({{random_centre(random), radius_px + k_rim_px}});
    flagged +=
        added_variance_px2(rim_offset_of(drawn.area_px, tool_of_radius(radius_px))) > 0 ? 1 : 0;
  }
  EXPECT_LE(flagged, 4);
}

struct Tally {
  double squares = 0, stated = 0;
  int count = 0, unnoticed = 0;
  void add(double off_px2, double variance) {
    ++count;
    squares += off_px2;
    stated += variance;
    unnoticed += variance == 0 ? 1 : 0;
    if (variance == 0) return;
    EXPECT_LT(off_px2, 3 * variance);
    EXPECT_GT(off_px2, 0.2 * variance);
  }
  void judge() const {
    std::printf("  off by %.2f px rms, %.2f stated, %d unnoticed\n", std::sqrt(squares / count),
                std::sqrt(stated / count), unnoticed);
    EXPECT_LT(unnoticed, count / 20);
    EXPECT_NEAR(stated / squares, 1, 0.2);
  }
};

TEST(BlobSize, SaysHowFarADiscBesideMovesTheMiddle) {
  Random random(2);
  Tally tally;
  constexpr int k_trials = 3000;
  for (int trial = 0; trial < k_trials; ++trial) {
    const double radius_px = random.within(2, 5);
    const Vector2 middle = random_centre(random);
    const double angle = random.within(0, 6.28);
    const double apart_px = random.within(2, 1.5 * radius_px);
    const SineCosine turn = sine_cosine(angle);
    const Drawn drawn =
        draw({{middle, radius_px + k_rim_px},
              {middle + apart_px * Vector2(turn.cosine, turn.sine), radius_px + k_rim_px}});
    tally.add(0.5 * (drawn.middle_px - middle).squaredNorm(),
              added_variance_px2(rim_offset_of(drawn.area_px, tool_of_radius(radius_px))));
  }
  tally.judge();
}

TEST(BlobSize, SaysHowFarAHiddenPartMovesTheMiddle) {
  Random random(3);
  Tally tally;
  constexpr int k_trials = 3000;
  for (int trial = 0; trial < k_trials; ++trial) {
    const double radius_px = random.within(2.5, 5);
    const Vector2 middle = random_centre(random);
    const double kept_px = random.within(-0.5, 0.4) * radius_px;  // beyond the centre
    const Drawn drawn = draw({{middle, radius_px + k_rim_px}}, middle.x() + kept_px);
    tally.add(0.5 * (drawn.middle_px - middle).squaredNorm(),
              added_variance_px2(rim_offset_of(drawn.area_px, tool_of_radius(radius_px))));
  }
  tally.judge();
}

TEST(BlobSize, AMergedBlobsRangeMayBeTheOthersAHiddenOnesIsItsOwn) {
  MarkerVariance merged, hidden;
  const double range_m2 = merged.range_m2;
  inflate(merged, 2);
  inflate(hidden, -2);
  EXPECT_GT(merged.range_m2, 10 * range_m2);
  EXPECT_EQ(hidden.range_m2, range_m2);
}

TEST(BlobSize, BlamesNoMarkerForWhatAllHave) {
  CommonRimOffset blurred;
  for (const double offset_px : {1.6, 1.9, 3.9}) blurred.add(offset_px);
  EXPECT_EQ(blurred.beyond(1.6), 0);
  EXPECT_NEAR(blurred.beyond(1.9), 0.3, 1e-12);
  EXPECT_NEAR(blurred.beyond(3.9), 2.3, 1e-12);
  CommonRimOffset low_signal;
  for (const double offset_px : {-1.6, -1.9, -3.9}) low_signal.add(offset_px);
  EXPECT_EQ(low_signal.beyond(-1.6), 0);
  EXPECT_NEAR(low_signal.beyond(-3.9), -2.3, 1e-12);
  CommonRimOffset mixed;
  for (const double offset_px : {-1.5, 0.1, 2.0}) mixed.add(offset_px);
  EXPECT_EQ(mixed.beyond(-1.5), -1.5);
  EXPECT_EQ(mixed.beyond(2.0), 2.0);
}

// Rim offset: the area in excess of the marker's disc, divided by half its rim.
TEST(BlobSize, IsTheAreaBeyondTheDiscsAlongHalfItsRim) {
  constexpr double k_pi = std::numbers::pi;
  for (const double radius_px : {1.5, 3.0, 6.0}) {
    for (const std::uint32_t area_px : {5U, 30U, 130U, 400U}) {
      const double offset_px =
          (area_px - k_pi * (radius_px + 0.3) * (radius_px + 0.3)) / (k_pi * radius_px);
      EXPECT_NEAR(rim_offset_of(area_px, tool_of_radius(radius_px)), offset_px, 1e-9);
      EXPECT_NEAR(rim_offset_of(area_px, tool_of_radius(radius_px, MarkerShape::disc)),
                  std::max(offset_px, 0.0), 1e-9);
    }
  }
}

TEST(BlobSize, WidensFromTheNoiseOnByWhatAStripMovesTheMiddle) {
  const auto widened = [](double rim_offset_px) {
    MarkerVariance variance{0.01, 0.003, 0.02, 1e-6};
    inflate(variance, rim_offset_px);
    return variance;
  };
  for (const double offset_px : {0.0, 0.7, -0.7}) {
    EXPECT_EQ(widened(offset_px).xx_px2, 0.01) << offset_px;
    EXPECT_EQ(widened(offset_px).range_m2, 1e-6) << offset_px;
    EXPECT_FALSE(is_merged(offset_px) || is_partially_occluded(offset_px));
  }
  EXPECT_TRUE(is_merged(0.7001) && !is_partially_occluded(0.7001));
  EXPECT_TRUE(is_partially_occluded(-0.7001) && !is_merged(-0.7001));
  const MarkerVariance merged = widened(2), hidden = widened(-2);
  const double by_merging = 0.5 * std::pow(2 * std::numbers::pi / 4, 2);
  EXPECT_NEAR(merged.xx_px2, 0.01 + by_merging, 1e-12);
  EXPECT_NEAR(merged.yy_px2, 0.02 + by_merging, 1e-12);
  EXPECT_NEAR(merged.range_m2, 1e-6 * 64 / 3, 1e-18) << "evenly within eight sigmas";
  EXPECT_NEAR(hidden.xx_px2, 0.01 + 0.5 * 1.6 * 1.6, 1e-12);
  EXPECT_NEAR(hidden.yy_px2, 0.02 + 0.5 * 1.6 * 1.6, 1e-12);
  EXPECT_EQ(merged.xy_px2, 0.003);
}

TEST(BlobSize, TellsNothingOfWhatIsNotSeenWhole) {
  const Tool sphere = tool_of_radius(3), disc = tool_of_radius(3, MarkerShape::disc);
  EXPECT_GT(rim_offset_of(60, sphere), 0);
  EXPECT_LT(rim_offset_of(10, sphere), -1);
  EXPECT_GT(rim_offset_of(60, disc), 0);
  EXPECT_EQ(rim_offset_of(10, disc), 0) << "it may be tilted";
  EXPECT_EQ(rim_offset_of(60, sphere, k_marker_touches_edge), 0);
  EXPECT_EQ(rim_offset_of(0, sphere), 0);
  EXPECT_EQ(rim_offset_of(60, tool_of_radius(0)), 0);
  Marker no_image;
  no_image.area_px = 60;
  EXPECT_EQ(rim_offset_px(no_image, {}, sphere, 0.5), 0);
}

}  // namespace
}  // namespace glint::blob_size_test
