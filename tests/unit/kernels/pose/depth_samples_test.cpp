#include "kernels/pose/depth_samples.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <set>
#include <vector>

#include "platform/formats/camera.hpp"

namespace glint {
namespace {

constexpr int k_side = 64;

// A small frame in which every pixel has a different depth, so a sample identifies its pixel.
class DepthSamplesOf : public testing::Test {
 protected:
  DepthSamplesOf() : depth_(k_side * k_side), bright_(k_side * k_side, 20000) {
    for (std::size_t i = 0; i < depth_.size(); ++i) depth_[i] = static_cast<std::uint16_t>(i + 1);
    camera_.lens = Lens::pinhole;
    camera_.fx = camera_.fy = 250;
    camera_.cx = camera_.cy = 32;
    settings_.unit_m = 1;  // so that a range is a raw value
    settings_.invalid_from = 0xFFFF;
    blob_.centroid_px = {32.2, 31.6};
    blob_.peak = 20000;
  }

  DepthSamples inner(double radius_px, int most) {
    return sampled([&](const DepthView& view, DepthSamples& out) {
      inner_samples(view, radius_px, most, out);
    });
  }
  DepthSamples ring(double radius_px, int most, int most_pixels) {
    return sampled([&](const DepthView& view, DepthSamples& out) {
      annulus_samples(view, radius_px, most, most_pixels, out);
    });
  }
  template <class Take>
  DepthSamples sampled(Take take) {
    Frame frame;
    frame.reflectivity_16 = {bright_.data(), k_side, k_side};
    frame.depth = {depth_.data(), k_side, k_side};
    int steps = 0;
    const LocalRays rays = local_rays(camera_, blob_.centroid_px, k_ray_steps_max, steps).value;
    DepthSamples out;
    take({frame, blob_, settings_, rays}, out);
    return out;
  }

  // Indices of the samples' pixels.
  static std::vector<std::size_t> pixels_of(const DepthSamples& samples) {
    std::vector<std::size_t> out;
    for (int i = 0; i < samples.count; ++i) {
      out.push_back(static_cast<std::size_t>(samples.range_m[static_cast<std::size_t>(i)]) - 1);
    }
    return out;
  }
  [[nodiscard]] Vector2 from_middle(std::size_t pixel) const {
    return Vector2{static_cast<double>(pixel % k_side) + 0.5,
                   static_cast<double>(pixel / k_side) + 0.5} -
           blob_.centroid_px;
  }
  // In row order, the pixels with inner <= distance < outer.
  [[nodiscard]] std::vector<std::size_t> pixels_between(double inner, double outer) const {
    std::vector<std::size_t> out;
    for (std::size_t i = 0; i < depth_.size(); ++i) {
      const double distance = from_middle(i).norm();
      if (distance >= inner && distance < outer) out.push_back(i);
    }
    return out;
  }

  std::vector<std::uint16_t> depth_, bright_;
  CameraModel camera_;
  DepthSettings settings_;
  Blob blob_;
};

TEST_F(DepthSamplesOf, TheDiscAreAllItsPixels) {
  for (const double radius : {0.5, 1.7, 3.0, 5.0, 5.2}) {
    const DepthSamples found = inner(radius, 64);
    const auto expected = pixels_between(0, std::max(0.7 * radius, 0.72));
    EXPECT_EQ(pixels_of(found), expected) << radius;
    EXPECT_EQ(found.tried, static_cast<int>(expected.size()));
    EXPECT_GE(found.pixels, found.tried);
  }
}

TEST_F(DepthSamplesOf, TheRingAreAllItsPixels) {
  const DepthSamples found = ring(4.3, 64, 1000);
  EXPECT_EQ(pixels_of(found), pixels_between(0.7 * 4.3, 4.8));
}

TEST_F(DepthSamplesOf, LeaveOutWhatHasNoDepthOfUse) {
  auto expected = pixels_between(0, 0.7 * 5);
  depth_[expected[3]] = 0;
  depth_[expected[9]] = 0xFFFF;
  bright_[expected[20]] = 0xFFFF;
  const auto tried = static_cast<int>(expected.size());
  for (const std::size_t i : {20u, 9u, 3u}) {
    expected.erase(expected.begin() + static_cast<std::ptrdiff_t>(i));
  }
  const DepthSamples found = inner(5, 64);
  EXPECT_EQ(pixels_of(found), expected);
  EXPECT_EQ(found.tried, tried);
  EXPECT_EQ(found.usable, tried - 3);
}

TEST_F(DepthSamplesOf, TheRingLeaveOutWhatIsMostlyBackground) {
  auto expected = pixels_between(0.7 * 4.3, 4.8);
  bright_[expected[7]] = 4999;
  bright_[expected[8]] = 5000;
  expected.erase(expected.begin() + 7);
  EXPECT_EQ(pixels_of(ring(4.3, 64, 1000)), expected);
}

// For any number: each sample is the last pixel of an equal part.
TEST_F(DepthSamplesOf, AFewAreSpreadEvenlyOverAllThatCount) {
  const auto all = pixels_between(0, 0.7 * 5);
  for (int most = 1; most <= static_cast<int>(all.size()); ++most) {
    const auto found = pixels_of(inner(5, most));
    ASSERT_EQ(found.size(), static_cast<std::size_t>(most));
    for (std::size_t i = 0; i < found.size(); ++i) {
      const double share = static_cast<double>(all.size()) / most;
      const auto place = static_cast<std::size_t>(std::ceil((i + 1.0) * share - 1e-9)) - 1;
      EXPECT_EQ(found[i], all[place]) << most << " " << i;
    }
  }
}

TEST_F(DepthSamplesOf, ALargeRingAreFromAllSidesAndFewPixelsAreLookedAt) {
  for (const int most_pixels : {47, 128, 6400}) {
    const DepthSamples found = ring(20, 16, most_pixels);
    EXPECT_LE(found.pixels, most_pixels);
    EXPECT_LE(found.count, 16);
    std::set<int> quarters;
    for (const std::size_t pixel : pixels_of(found)) {
      const Vector2 at = from_middle(pixel);
      quarters.insert((at.x() > 0 ? 1 : 0) + (at.y() > 0 ? 2 : 0));
    }
    EXPECT_EQ(quarters.size(), 4u) << most_pixels;
  }
}

TEST_F(DepthSamplesOf, ABlobAtTheBorderStayInTheFrame) {
  for (const Vector2& corner : {Vector2{0.1, 0.2}, {63.9, 0.1}, {0.2, 63.8}, {63.7, 63.9}}) {
    blob_.centroid_px = corner;
    EXPECT_EQ(pixels_of(inner(5, 64)), pixels_between(0, 0.7 * 5));
    EXPECT_EQ(pixels_of(ring(4.3, 64, 1000)), pixels_between(0.7 * 4.3, 4.8));
  }
}

// Radii are half-open: a pixel at the inner radius belongs to the annulus, not to the disc. One at
// the outer radius is outside the annulus.
TEST_F(DepthSamplesOf, ARadiusBeginsARingAndEndsADisc) {
  const auto at = [&](double distance) {
    return pixels_between(distance, std::nextafter(distance, 99.0)).size();
  };
  blob_.centroid_px = {32, 31.5};
  ASSERT_EQ(at(3.5), 2u);
  EXPECT_EQ(pixels_of(inner(5, 64)), pixels_between(0, 3.5));
  blob_.centroid_px = {32.5, 31.5};
  ASSERT_EQ(at(7), 4u);
  ASSERT_EQ(at(5), 12u);
  EXPECT_EQ(ring(10, 64, 1000).tried, static_cast<int>(pixels_between(7, 10.5).size()));
  EXPECT_EQ(pixels_of(ring(4.5, 64, 1000)), pixels_between(0.7 * 4.5, 5));
}

// Both kinds of frame, with the same levels.
TEST_F(DepthSamplesOf, AreTheSameOfEightBits) {
  for (std::size_t i = 0; i < bright_.size(); ++i)
    bright_[i] = static_cast<std::uint16_t>(40 + (7 * i) % 200);
  blob_.peak = 240;
  settings_.saturated_from = 230;
  const std::vector<std::uint8_t> narrow(bright_.begin(), bright_.end());
  const auto of_eight = [&](auto take) {
    Frame frame;
    frame.reflectivity_8 = {narrow.data(), k_side, k_side};
    frame.depth = {depth_.data(), k_side, k_side};
    int steps = 0;
    const LocalRays rays = local_rays(camera_, blob_.centroid_px, k_ray_steps_max, steps).value;
    DepthSamples out;
    take(DepthView{frame, blob_, settings_, rays}, out);
    return out;
  };
  const DepthSamples disc =
      of_eight([](const DepthView& view, DepthSamples& out) { inner_samples(view, 5, 64, out); });
  const DepthSamples around = of_eight(
      [](const DepthView& view, DepthSamples& out) { annulus_samples(view, 4.3, 64, 1000, out); });
  const DepthSamples wide_disc = inner(5, 64), wide_ring = ring(4.3, 64, 1000);
  EXPECT_EQ(pixels_of(disc), pixels_of(wide_disc));
  EXPECT_EQ(pixels_of(around), pixels_of(wide_ring));
  EXPECT_LT(disc.usable, disc.tried) << "some are saturated";
  EXPECT_EQ(around.tried, wide_ring.tried);
}

// Only pixels that both images contain are read.
TEST_F(DepthSamplesOf, StayInTheSmallerOfTheTwoPictures) {
  blob_.centroid_px = {29.7, 28.4};
  for (const bool small_depth : {false, true}) {
    const std::vector<std::uint16_t> depth(31 * 30, 7), bright(31 * 30, 20000);
    Frame frame;
    frame.reflectivity_16 = {bright_.data(), k_side, k_side};
    frame.depth = {depth_.data(), k_side, k_side};
    (small_depth ? frame.depth : frame.reflectivity_16) = {
        small_depth ? depth.data() : bright.data(), 31, 30};
    int steps = 0;
    const LocalRays rays = local_rays(camera_, blob_.centroid_px, k_ray_steps_max, steps).value;
    DepthSamples out;
    inner_samples({frame, blob_, settings_, rays}, 5, 64, out);
    int held = 0;
    for (int y = 0; y < 30; ++y)
      for (int x = 0; x < 31; ++x)
        held += (Vector2(x + 0.5, y + 0.5) - blob_.centroid_px).norm() < 3.5 ? 1 : 0;
    EXPECT_EQ(out.count, held) << small_depth;
    EXPECT_EQ(out.tried, held) << small_depth;
  }
}

// The square around the circle, with the smallest step that fits the pixel budget.
TEST_F(DepthSamplesOf, TheRingTakeTheSmallestStepThatFits) {
  const auto pixels = [](int step) {
    const int side = (42 + step - 1) / step;  // columns and rows 11 to 52
    return side * side;
  };
  blob_.centroid_px = {32.0, 32.0};
  for (const int most : {2000, 1023, 441, 440, 196, 195, 121, 120, 4, 1, 0, -5}) {
    int step = 1;
    while (pixels(step) > std::max(std::min(most, k_square_max_px), 1)) ++step;
    EXPECT_EQ(ring(19.9, 64, most).pixels, pixels(step)) << most;
  }
}

// Limited to the largest radius, for any blob.
TEST_F(DepthSamplesOf, TheRingOfAHugeBlobEndAtTheLargestRadius) {
  for (const double radius : {38.5, 45.0, 55.0}) {
    const DepthSamples found = ring(radius, 64, 1024);
    EXPECT_GT(found.tried, 0);
    for (const std::size_t pixel : pixels_of(found)) {
      EXPECT_LT(from_middle(pixel).norm(), k_scan_radius_max_px - 1);
      EXPECT_GE(from_middle(pixel).norm(), 0.7 * radius);
    }
  }
  EXPECT_EQ(ring(60, 64, 1024).tried, 0) << "its ring lies further out";
}

// Valid raw values are 1 to below invalid_from; an invalid_from of 0 or 1 leaves none.
TEST_F(DepthSamplesOf, CountEachDepthBetweenNoneAndInvalid) {
  for (const std::uint16_t invalid_from : {0, 1, 2, 500, 0xFFFF}) {
    settings_.invalid_from = invalid_from;
    for (const std::uint16_t raw : {0, 1, 499, 500, 0xFFFE, 0xFFFF}) {
      std::fill(depth_.begin(), depth_.end(), raw);
      const DepthSamples found = inner(5, 64);
      EXPECT_EQ(found.usable, raw >= 1 && raw < invalid_from ? found.tried : 0)
          << raw << " of " << invalid_from;
    }
  }
}

TEST_F(DepthSamplesOf, SayHowFarBesideTheMiddleTheyLie) {
  settings_.kind = DepthKind::z;
  const DepthSamples found = inner(5, 7);  // odd, so the last sample has no partner
  ASSERT_EQ(found.count, 7);
  const Vector3 middle = unproject(camera_, blob_.centroid_px).value;
  for (std::size_t i = 0; i < 7; ++i) {
    const Vector2 at = blob_.centroid_px + from_middle(pixels_of(found)[i]);
    const Vector3 ray = unproject(camera_, at).value;
    const double beside = (ray / ray.dot(middle) - middle).squaredNorm();
    EXPECT_NEAR(found.offset_square[i], beside, 1e-6 + 0.01 * beside);
    EXPECT_NEAR(found.radial_factor[i], 1 / ray.z(), 1e-5);
  }
}

}  // namespace
}  // namespace glint
