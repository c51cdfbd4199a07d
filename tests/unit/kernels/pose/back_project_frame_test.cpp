// Back-projection of a frame's markers: equality with single markers, work counts, and the range's
// sigma from its samples.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <numbers>
#include <vector>

#include "kernels/pose/back_project.hpp"
#include "kernels/pose/depth_samples.hpp"

namespace glint::back_project_frame_test {
namespace {

constexpr int k_side = 128;
constexpr double k_range_m = 0.6;

// Flat discs that face the camera; the whole frame has one range.
struct Scene {
  std::vector<std::uint16_t> bright = std::vector<std::uint16_t>(k_side * k_side, 20000);
  std::vector<std::uint16_t> depth = std::vector<std::uint16_t>(k_side * k_side, 600);
  CameraModel camera;
  DepthSettings settings;
  NominalMarker nominal{0.008, MarkerShape::disc};
  Limits limits;
  std::unique_ptr<Blobs> blobs = std::make_unique<Blobs>();
  std::unique_ptr<Markers> markers = std::make_unique<Markers>();

  Scene() {
    camera.width = camera.height = k_side;
    camera.fx = camera.fy = 250;
    camera.cx = camera.cy = 64;
  }
  [[nodiscard]] Frame frame() const {
    Frame out;
    out.reflectivity_16 = {bright.data(), k_side, k_side};
    out.depth = {depth.data(), k_side, k_side};
    return out;
  }
  Blob& add(const Vector2& centroid_px, std::uint32_t area_px) {
    Blob& blob = blobs->items[static_cast<std::size_t>(blobs->count++)];
    blob = Blob{};
    blob.centroid_px = centroid_px;
    blob.area_px = area_px;
    blob.peak = 20000;
    blob.variance_px2 = {0.0004F, 0.0009F};
    return blob;
  }
  BackProjectWork project() {
    return back_project(frame(), *blobs, camera, {}, settings, nominal, *markers, limits);
  }
  [[nodiscard]] Marker measured(int blob) const {
    Marker marker;
    EXPECT_TRUE(measure_marker(frame(), blobs->items[static_cast<std::size_t>(blob)],
                               static_cast<std::uint16_t>(blob), camera, {}, settings, nominal,
                               marker));
    return marker;
  }
  // Removes the depth of all pixels within this distance.
  void remove_depth(const Vector2& middle, double within_px) {
    for (int y = 0; y < k_side; ++y)
      for (int x = 0; x < k_side; ++x)
        if ((Vector2(x + 0.5, y + 0.5) - middle).norm() < within_px)
          depth[static_cast<std::size_t>(k_side * y + x)] = 0;
  }
};

int pixels_within(const Vector2& middle, double radius_px) {
  int count = 0;
  for (int y = 0; y < k_side; ++y)
    for (int x = 0; x < k_side; ++x)
      count += (Vector2(x + 0.5, y + 0.5) - middle).norm() < radius_px ? 1 : 0;
  return count;
}

void expect_same(const Marker& a, const Marker& b) {
  EXPECT_EQ(a.ray, b.ray);
  EXPECT_EQ(a.along_x, b.along_x);
  EXPECT_EQ(a.along_y, b.along_y);
  EXPECT_EQ(a.surface_range_m, b.surface_range_m);
  EXPECT_EQ(a.centroid_px, b.centroid_px);
  EXPECT_EQ(a.area_px, b.area_px);
  EXPECT_EQ(a.blob, b.blob);
  EXPECT_EQ(a.flags, b.flags);
  EXPECT_EQ(a.sigma_px, b.sigma_px);
  EXPECT_EQ(a.range_sigma_m, b.range_sigma_m);
  EXPECT_EQ(a.bias_subtracted_m, b.bias_subtracted_m);
  EXPECT_EQ(a.peak, b.peak);
}

void expect_work(const BackProjectWork& found, const BackProjectWork& expected) {
  EXPECT_EQ(found.blobs, expected.blobs);
  EXPECT_EQ(found.lens_steps, expected.lens_steps);
  EXPECT_EQ(found.pixels, expected.pixels);
  EXPECT_EQ(found.samples, expected.samples);
  EXPECT_EQ(found.unwrapped, expected.unwrapped);
}

BackProjectWork sum_of(const BackProjectWork& a, const BackProjectWork& b) {
  return {a.blobs + b.blobs, a.lens_steps + b.lens_steps, a.pixels + b.pixels,
          a.samples + b.samples, a.unwrapped + b.unwrapped};
}

// Each field of each marker; a blob without a ray is among them.
TEST(BackProjectFrame, HasEachBlobsMarkerInOrderButThoseWithoutARay) {
  Scene scene;
  scene.camera.lens = Lens::brown;
  scene.camera.distortion = {-0.1, 0.02};
  scene.camera.field_tangent_max = 0.3;
  scene.settings.bias = {0.004, 0, 0.001, 0.1, 1};
  scene.add({30.2, 40.7}, 33).flags = k_blob_saturated;
  scene.add({1, 1}, 30);  // outside the lens's field
  scene.add({80.1, 90.3}, 41).flags = k_blob_has_neighbour;
  scene.add({60.1, 20.3}, 29).flags = k_blob_partial_or_merged;
  scene.remove_depth({60.1, 20.3}, 9);
  scene.blobs->incomplete = Reason::runs_full;
  scene.project();
  EXPECT_EQ(scene.markers->incomplete, Reason::runs_full);
  ASSERT_EQ(scene.markers->count, 3);
  const int blob_of[] = {0, 2, 3};
  for (std::size_t i = 0; i < 3; ++i) {
    const Marker& marker = scene.markers->items[i];
    expect_same(marker, scene.measured(blob_of[i]));
    EXPECT_EQ(marker.blob, blob_of[i]);
    EXPECT_EQ(marker.sigma_px, (std::array<float, 2>{std::sqrt(0.0004F), std::sqrt(0.0009F)}));
    EXPECT_EQ(marker.area_px, scene.blobs->items[marker.blob].area_px);
    EXPECT_EQ(marker.centroid_px, scene.blobs->items[marker.blob].centroid_px);
  }
  const auto& items = scene.markers->items;
  EXPECT_EQ(items[0].flags, k_marker_saturated);
  EXPECT_EQ(items[1].flags, k_marker_has_neighbour);
  EXPECT_EQ(items[2].flags, k_marker_not_isolated | k_marker_no_depth);
  // 4 mm plus 1 mm times 1000 / counts: at 20000 counts a twentieth of it.
  EXPECT_NEAR(items[0].bias_subtracted_m, 0.00405, 1e-9);
  EXPECT_NEAR(items[0].surface_range_m, k_range_m - 0.00405, 1e-9);
  EXPECT_EQ(items[0].peak, 20000);
  EXPECT_EQ(items[2].peak, 0) << "nothing was measured";
  EXPECT_EQ(items[2].surface_range_m, 0);
}

TEST(BackProjectFrame, CountsTheSumOfItsBlobsWork) {
  Scene both;
  both.camera.lens = Lens::brown;
  both.camera.distortion = {-0.1, 0.02};
  both.settings.wrap_range_m = 1.0;
  both.nominal.radius_m = 0.008;
  both.add({30.2, 40.7}, 35);  // expected size at its range
  both.add({80.1, 90.3}, 5);   // expected size one wrap distance behind it
  both.add({64.1, 20.3}, 37);
  both.remove_depth({64.1, 20.3}, 2.5);  // depth in the annulus only
  BackProjectWork sum;
  for (std::size_t i = 0; i < 3; ++i) {
    Scene one;
    one.camera = both.camera;
    one.settings = both.settings;
    one.depth = both.depth;
    one.blobs->items[0] = both.blobs->items[i];
    one.blobs->count = 1;
    const BackProjectWork work = one.project();
    EXPECT_EQ(work.blobs, 1);
    EXPECT_GT(work.lens_steps, 0);
    EXPECT_EQ(work.unwrapped, i == 1 ? work.samples : 0) << "averaged again where it wrapped";
    EXPECT_GT(work.samples, 0);
    EXPECT_GE(work.pixels, work.samples);
    sum = sum_of(sum, work);
  }
  expect_work(both.project(), sum);
  EXPECT_NE(both.markers->items[1].flags & k_marker_wrapped, 0);
  EXPECT_NE(both.markers->items[2].flags & k_marker_annulus_depth, 0);
  // A blob without a ray is counted, and so are its lens steps.
  both.camera.field_tangent_max = 0.01;
  const BackProjectWork none = both.project();
  EXPECT_EQ(both.markers->count, 0);
  EXPECT_EQ(none.blobs, 3);
  EXPECT_EQ(none.lens_steps, sum.lens_steps);
  EXPECT_EQ(none.pixels, 0);
}

// The samples are the pixels of the disc of half the area; the pixels read are its bounding square.
TEST(BackProjectFrame, CountsTheSquareAroundTheInnerDiscAndItsPixels) {
  Scene scene;
  const Vector2 middle{30.2, 40.7};
  scene.add(middle, 60);
  const double inner = 0.7 * std::sqrt(60 / std::numbers::pi);
  const BackProjectWork work = scene.project();
  EXPECT_EQ(work.samples, pixels_within(middle, inner));
  const auto side = [&](double at) {
    return static_cast<int>(at + inner) - static_cast<int>(at - inner) + 1;
  };
  EXPECT_EQ(work.pixels, side(30.2) * side(40.7));
  EXPECT_EQ(work.lens_steps, 0) << "a pinhole has none";
}

TEST(BackProjectFrame, LooksAtNoMoreBlobsThanTheLimitAndHasNothingOfAFrameBefore) {
  Scene scene;
  for (int i = 0; i < 9; ++i) scene.add({20.0 + 8 * i, 50}, 20);
  for (const int most : {9, 5, 1, 0}) {
    scene.limits.blobs = most;
    const BackProjectWork work = scene.project();
    EXPECT_EQ(work.blobs, most);
    EXPECT_EQ(scene.markers->count, most);
  }
  scene.limits.blobs = 9;
  scene.project();
  scene.blobs->count = -2;
  EXPECT_EQ(scene.project().blobs, 0);
  EXPECT_EQ(scene.markers->count, 0);
  scene.blobs->count = 0;
  scene.blobs->incomplete = Reason::none;
  scene.project();
  EXPECT_EQ(scene.markers->incomplete, Reason::none);
}

// Large blobs: a single one uses what the others leave, each of four has its share. The same holds
// for samples and for pixels.
TEST(BackProjectFrame, LeavesEachBlobItsShare) {
  for (const int count : {1, 4}) {
    for (const bool without_depth : {false, true}) {
      Scene scene;
      scene.limits.blobs = 4;
      scene.limits.range_samples_per_blob = 12;
      scene.limits.range_pixels_per_blob = 90;
      for (int i = 0; i < count; ++i) {
        const Vector2 middle{i == 0 ? 64.0 : 20.0 + 25 * i, i == 0 ? 64.0 : 20.0};
        scene.add(middle, 2000);
        if (without_depth) scene.remove_depth(middle, 5);  // so that the annulus is read
      }
      const BackProjectWork work = scene.project();
      EXPECT_LE(work.pixels, 90 * 4);
      EXPECT_LE(work.samples, 12 * 4);
      if (without_depth) continue;
      EXPECT_EQ(work.samples, count == 1 ? pixels_within({64, 64}, 3.7) : 12 * 4);
      for (int i = 0; i < count; ++i) {
        const Marker& marker = scene.markers->items[static_cast<std::size_t>(i)];
        EXPECT_EQ(marker.flags & k_marker_no_depth, 0);
        EXPECT_EQ(marker.range_sigma_m, scene.markers->items[0].range_sigma_m) << "as many samples";
      }
    }
  }
}

TEST(BackProjectFrame, MaximumIsTheLimitsForEachBlob) {
  Limits limits;
  limits.blobs = 7;
  limits.ray_steps = 6;
  limits.range_pixels_per_blob = 110;
  limits.range_samples_per_blob = 13;
  expect_work(back_project_work_max(limits), {7, 42, 770, 91, 91});
}

// Equal samples: the spread is the sensor's step, and the declared sigma counts as two more
// samples.
TEST(BackProjectFrame, StatesTheMeansErrorByNumberSpreadAndBias) {
  const auto sigma = [](int samples, double declared_m, double bias_m) {
    const double spread = 0.001 / 3;
    const double variance =
        (samples * spread * spread + 2 * declared_m * declared_m) / ((samples + 2.0) * samples);
    return std::sqrt(variance + bias_m * bias_m);
  };
  const Vector2 middle{30.2, 40.7};
  for (const unsigned area : {3U, 20U, 60U}) {
    for (const bool saturated : {false, true}) {
      Scene scene;
      scene.settings.pixel_sigma_m = 0.007;
      Blob& blob = scene.add(middle, area);
      if (saturated) blob.flags = k_blob_saturated;
      const double radius = std::sqrt(area / std::numbers::pi);
      const int inner = pixels_within(middle, std::max(0.7 * radius, 0.72));
      EXPECT_NEAR(scene.measured(0).range_sigma_m, sigma(inner, 0.007, 0.0001), 1e-8) << area;
      // From the annulus the sigma is larger, and larger still if the blob is saturated.
      scene.remove_depth(middle, std::max(0.7 * radius, 0.72));
      const int ring =
          pixels_within(middle, radius + 0.5) - pixels_within(middle, std::max(0.7 * radius, 0.72));
      if (ring == 0) continue;
      EXPECT_NEAR(scene.measured(0).range_sigma_m, sigma(ring, 0.007, saturated ? 0.0035 : 0.001),
                  1e-8)
          << area;
      EXPECT_NE(scene.measured(0).flags & k_marker_annulus_depth, 0);
    }
  }
}

// A quarter of the inner disc's pixels is enough for a range from the inner disc.
TEST(BackProjectFrame, TakesTheRingWhereLessThanAQuarterOfTheInnerPixelsHasDepth) {
  const Vector2 middle{30.2, 40.7};
  const double inner = 0.7 * std::sqrt(60 / std::numbers::pi);
  const int all = pixels_within(middle, inner);
  for (int left = 1; left <= all; ++left) {
    Scene scene;
    scene.add(middle, 60);
    int kept = 0;
    for (int y = 0; y < k_side; ++y)
      for (int x = 0; x < k_side; ++x)
        if ((Vector2(x + 0.5, y + 0.5) - middle).norm() < inner && kept++ >= left)
          scene.depth[static_cast<std::size_t>(k_side * y + x)] = 0;
    EXPECT_EQ((scene.measured(0).flags & k_marker_annulus_depth) != 0, left < 0.25 * all) << left;
  }
}

// Merged with another marker: sigma is larger by its own radius in pixels.
TEST(BackProjectFrame, WidensABlobThatIsLargerThanAMarkerByItsRadius) {
  const double radius_px = 250 * 0.008 / k_range_m;
  const double limit = 1.5 * std::numbers::pi * (radius_px + 1) * (radius_px + 1);
  for (const bool larger : {false, true}) {
    Scene scene;
    scene.add({64, 64}, static_cast<unsigned>(limit) + (larger ? 1 : 0));
    const Marker marker = scene.measured(0);
    EXPECT_EQ((marker.flags & k_marker_not_isolated) != 0, larger);
    EXPECT_NEAR(marker.sigma_px[0], 0.02 + (larger ? radius_px : 0), 1e-3);
    EXPECT_NEAR(marker.sigma_px[1], 0.03 + (larger ? radius_px : 0), 1e-3);
    scene.nominal.radius_m = 0;
    EXPECT_EQ(scene.measured(0).flags & k_marker_not_isolated, 0) << "nothing is expected";
  }
}

}  // namespace
}  // namespace glint::back_project_frame_test
