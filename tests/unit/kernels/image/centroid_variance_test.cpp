#include "kernels/image/centroid_variance.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <random>

#include "kernels/image/blobs.hpp"
#include "kernels/image/roi_threshold.hpp"
#include "tests/unit/kernels/image/test_image.hpp"

namespace glint::centroid_variance_test {
namespace {

using test::TestImage;

// A disc of 6 px: 28 pixels of 10,000 counts over a background of 100.
Centroid disc_of_light(double signal = 10'000) {
  Centroid c;
  c.position_px = {20, 20};
  c.peak = static_cast<std::uint16_t>(signal + 100);
  c.intensity_sum = 28 * signal;
  c.background = 100;
  c.pixels = 60;
  c.dark_pixels = 32;
  return c;
}
Component box_of_disc(int width = 7, int height = 7) {
  Component component;
  component.area_px = 38;
  component.x0 = component.y0 = 17;
  component.x1 = static_cast<std::uint16_t>(17 + width);
  component.y1 = static_cast<std::uint16_t>(17 + height);
  return component;
}
const BlobSettings k_settings{2, 4096, 1000, 0xFFFF, {6, 0.35, 0.01}};

// Noise dominates: the rim's variance is 6e-5 px^2, that of the noise 0.02 px^2.
TEST(CentroidVariance, OfDarkNoiseIsThatOfTheFirstMoment) {
  BlobSettings settings = k_settings;
  settings.noise = {400, 0, 0};
  const auto variance = centroid_variance(disc_of_light(), box_of_disc(), settings);
  const double noisy = 400.0 * 400.0 * 60 * (9.0 * 9 / 16) / (28e4 * 28e4);
  EXPECT_NEAR(variance[0], noisy, 1e-4);
  EXPECT_EQ(variance[0], variance[1]);
}

TEST(CentroidVariance, HoldsWhatTheBackgroundsMeanIsOff) {
  BlobSettings settings = k_settings;
  settings.noise = {400, 0, 0};
  Centroid cut = disc_of_light();
  const auto even = centroid_variance(cut, box_of_disc(), settings);
  cut.lever_px = {100, 0};
  const auto lever = centroid_variance(cut, box_of_disc(), settings);
  EXPECT_NEAR(lever[0] - even[0], 400.0 * 400.0 * 100 * 100 / 32 / (28e4 * 28e4), 1e-6);
  EXPECT_EQ(lever[1], even[1]);
}

TEST(CentroidVariance, FallsWithTheLight) {
  BlobSettings settings = k_settings;
  settings.noise.proportional = 0;
  settings.threshold = 100;
  float last = 1e9F;
  for (const double signal : {2e3, 4e3, 8e3, 16e3, 32e3}) {
    const auto variance = centroid_variance(disc_of_light(signal), box_of_disc(), settings);
    EXPECT_LT(variance[0], last) << signal;
    last = variance[0];
  }
}

TEST(CentroidVariance, GrowsWhereTheRimIsClipped) {
  Centroid clipped = disc_of_light(65'435);
  const auto unclipped_variance =
      centroid_variance(disc_of_light(60'000), box_of_disc(), k_settings);
  const auto least = centroid_variance(clipped, box_of_disc(), k_settings);
  clipped.intensity_sum = 37 * 65'435.0;  // nearly all of 38 pixels are full
  const auto most = centroid_variance(clipped, box_of_disc(), k_settings);
  EXPECT_GT(least[0], 20 * unclipped_variance[0]);
  EXPECT_GT(most[0], 3 * least[0]);
  EXPECT_NEAR(std::sqrt(most[0]), 0.08, 0.01);  // all full: 0.2 / sqrt(D)
}

TEST(CentroidVariance, HoldsTheLightOfANeighbour) {
  Centroid beside = disc_of_light();
  const auto alone = centroid_variance(beside, box_of_disc(), k_settings);
  beside.has_bright_rim = true;
  const auto pulled = centroid_variance(beside, box_of_disc(), k_settings);
  EXPECT_NEAR(std::sqrt(pulled[0] - alone[0]), 3 * 900 * 4.5 / 28e4, 1e-4);
}

TEST(CentroidVariance, OfThePlainMeanIsThatOfAFullRim) {
  Centroid plain;
  plain.position_px = {20, 20};
  const auto variance = centroid_variance(plain, box_of_disc(), k_settings);
  EXPECT_NEAR(std::sqrt(variance[0]), 0.08, 0.01);
}

TEST(CentroidVariance, KnowsABoxThatIsNoDiscs) {
  EXPECT_FALSE(is_partial_or_merged(box_of_disc(7, 7)));
  EXPECT_FALSE(is_partial_or_merged(box_of_disc(7, 5)));   // 4 px, motion blur of 2
  EXPECT_FALSE(is_partial_or_merged(box_of_disc(12, 8)));  // 7 px, motion blur of 4
  EXPECT_TRUE(is_partial_or_merged(box_of_disc(9, 5)));    // two of 4 px
  EXPECT_TRUE(is_partial_or_merged(box_of_disc(7, 13)));
  const auto merged = shape_variance(box_of_disc(13, 7), false, false);
  EXPECT_EQ(merged[0], 9.0F);
  const auto cut = shape_variance(box_of_disc(5, 7), true, false);
  EXPECT_EQ(cut[0], 4.0F);
  EXPECT_EQ(cut[1], 1.0F);
}

// Extreme inputs: the variance is finite and not negative.
TEST(CentroidVariance, IsANumberForAnyBlob) {
  std::mt19937_64 random(3);
  for (int round = 0; round < 20'000; ++round) {
    const auto any = [&](double least, double most) {
      const double part = static_cast<double>(random() >> 11) * 0x1p-53;
      return round % 3 == 0 ? (random() % 2 != 0 ? least : most) : least + part * (most - least);
    };
    Centroid c;
    c.peak = static_cast<std::uint16_t>(any(0, 65535));
    c.background = any(0, 65535);
    c.intensity_sum = any(1.0 / 4096, 65535.0 * 4096);
    c.pixels = static_cast<std::int32_t>(any(0, 4096));
    c.dark_pixels = static_cast<std::int32_t>(any(1, 4096));
    c.lever_px = {any(-3e5, 3e5), any(-3e5, 3e5)};
    c.has_bright_rim = round % 2 == 0;
    Component component = box_of_disc(static_cast<int>(any(1, 400)), static_cast<int>(any(1, 400)));
    component.area_px = static_cast<std::uint32_t>(any(1, 262144));
    BlobSettings settings = k_settings;
    settings.threshold = static_cast<std::uint16_t>(any(0, 65535));
    for (const float variance : centroid_variance(c, component, settings)) {
      ASSERT_TRUE(std::isfinite(variance) && variance > 0) << round;
    }
  }
}

// Bits of g++ -O3 and clang++ -O1 on x86-64 and of g++ on arm64.
TEST(CentroidVariance, HasTheSameBitsEverywhere) {
  Centroid c = disc_of_light(4321.5);
  c.lever_px = {3.25, -1.5};
  const auto variance = centroid_variance(c, box_of_disc(7, 8), k_settings);
  EXPECT_EQ(variance[0], 0x1.a14244p-16F);
  EXPECT_EQ(variance[1], 0x1.06639ep-15F);
}

// Discs with noise as declared, through all of find_blobs: the stated variance matches the mean
// squared error.
TEST(CentroidVariance, IsTheSquaredErrorsMean) {
  for (const double noise : {150.0, 600.0}) {
    auto runs = std::make_unique<Runs>();
    auto scratch = std::make_unique<BlobScratch>();
    auto blobs = std::make_unique<Blobs>();
    const BlobSettings settings{2, 4096, 4500, 0xFFFF, {noise, 0, 0}};
    std::mt19937 random(17);
    std::uniform_real_distribution<double> part(0, 1);
    double squares = 0, variances = 0;
    for (int round = 0; round < 400; ++round) {
      TestImage p(40, 40, 1000);
      const Vector2 truth{18 + part(random), 18 + part(random)};
      test::add_disc(p, truth.x(), truth.y(), 2.5 + part(random), 8000);
      for (auto& value : p.pixels_16) {  // a mean of twelve uniform numbers is nearly Gaussian
        double sum = -6;
        for (int i = 0; i < 12; ++i) sum += part(random);
        value = static_cast<std::uint16_t>(std::max(value + noise * sum + 0.5, 0.0));
      }
      const Frame frame = p.frame();
      threshold_runs(frame, whole_frame(frame), settings.threshold, {}, *runs);
      const Runs* const bands[] = {runs.get()};
      find_blobs(frame, bands, settings, {}, *scratch, *blobs);
      ASSERT_EQ(blobs->count, 1);
      const Blob& blob = blobs->items[0];
      squares += (blob.centroid_px - truth).squaredNorm();
      variances += blob.variance_px2[0] + blob.variance_px2[1];
    }
    EXPECT_NEAR(std::sqrt(squares / variances), 1, 0.25) << noise;
  }
}

}  // namespace
}  // namespace glint::centroid_variance_test
