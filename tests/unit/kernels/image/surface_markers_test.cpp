// Markers before a bright surface: find_blobs separates them, with the centroid's stated error.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>

#include "kernels/image/blobs.hpp"
#include "kernels/image/roi_threshold.hpp"
#include "tests/unit/kernels/image/blob_finder.hpp"
#include "tests/unit/kernels/image/test_image.hpp"

namespace glint::surface_markers_test {
namespace {

using test::BlobFinder;
using test::TestImage;

constexpr BlobSettings k_settings{1, 100, 40, 0xFFFF};

// Mean of (error / stated sigma)^2, both axes, of markers of 2,700 counts on a surface of 606 that
// ends at column x1; out: the errors' root mean square, px.
double nees_on_surface(int x1, double& rms_px) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> shift(0, 1);
  std::normal_distribution<double> noise(0, 1);
  BlobFinder find{k_settings};
  find.settings.threshold = 250;
  find.settings.noise = {6, 0.35, 0.01};
  double nees = 0, square = 0;
  constexpr int count = 2 * 300;
  for (int i = 0; i < count / 2; ++i) {
    const Vector2 at(40 + shift(random), 30 + shift(random));
    TestImage p(90, 70, 5), disc(90, 70);
    test::add_surface(p, 10, 8, x1, 62, 606);
    test::add_disc(disc, at.x(), at.y(), 3, 1000);
    for (std::size_t k = 0; k < p.pixels_16.size(); ++k) {
      const double covered = disc.pixels_16[k] / 1000.0;
      const double value = covered * 2700 + (1 - covered) * p.pixels_16[k];
      const double sigma = std::sqrt(36 + 0.35 * value + 1e-4 * value * value);
      p.pixels_16[k] = static_cast<std::uint16_t>(std::max(value + sigma * noise(random), 0.0));
    }
    find(p);
    EXPECT_EQ(find.blobs->count, 1) << i;
    const Blob& blob = find.blobs->items[0];
    const Vector2 error = blob.centroid_px - at;
    square += error.squaredNorm() / count;
    for (const int axis : {0, 1})
      nees += error(axis) * error(axis) / blob.variance_px2[static_cast<std::size_t>(axis)] / count;
  }
  rms_px = std::sqrt(square);
  return nees;
}

TEST(SurfaceMarkers, FindsAMarkerOnABrightSurfaceWithinItsStatedError) {
  double rms_px = 0;
  const double nees = nees_on_surface(80, rms_px);
  EXPECT_LT(rms_px, 0.02);
  EXPECT_LT(nees, 1.5);
  EXPECT_GT(nees, 0.3);
}

TEST(SurfaceMarkers, StatesTheErrorByASurfacesEdge) {
  for (const int x1 : {39, 40, 41, 42}) {
    double rms_px = 0;
    const double nees = nees_on_surface(x1, rms_px);
    EXPECT_GT(rms_px, 0.1) << x1;
    EXPECT_LT(nees, 4) << x1;
    EXPECT_GT(nees, 0.2) << x1;
  }
}

TEST(SurfaceMarkers, FindsNoCandidateInATexture) {
  for (const int pitch : {2, 4, 6, 12}) {
    TestImage p(90, 70, 4);
    for (int y = 8; y < 62; ++y)
      for (int x = 10; x < 80; ++x)
        p(x, y) = static_cast<std::uint16_t>((x / pitch + y / pitch) % 2 == 0 ? 60 : 200 + x % 16);
    BlobFinder find{k_settings};
    const BlobWork work = find(p);
    EXPECT_GT(work.rescans, 0) << pitch;
    EXPECT_EQ(find.scratch->component_count, 1) << pitch;
    EXPECT_EQ(find.blobs->count, 0) << pitch;
    EXPECT_EQ(find.blobs->incomplete, Reason::none) << pitch;
  }
}

// The level is 90 counts: a marker has at least 135.
TEST(SurfaceMarkers, RequiresAMarkersContrast) {
  for (const int value : {100, 134, 135, 200}) {
    TestImage p(90, 70, 4);
    test::add_surface(p, 10, 8, 80, 62, 60);
    test::add_surface(p, 40, 30, 43, 33, value);
    BlobFinder find{k_settings};
    find(p);
    ASSERT_EQ(find.scratch->component_count, 2) << value;
    EXPECT_EQ(find.scratch->components[1].level, 90) << value;
    EXPECT_EQ(find.blobs->count, value >= 135 ? 1 : 0) << value;
    EXPECT_EQ(find.blobs->dropped, value >= 135 ? 1u : 2u) << value;
  }
}

}  // namespace
}  // namespace glint::surface_markers_test
