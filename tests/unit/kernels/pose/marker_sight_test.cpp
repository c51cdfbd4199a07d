#include "kernels/pose/marker_sight.hpp"

#include <gtest/gtest.h>

#include "tests/unit/kernels/pose/weighted_scene.hpp"

namespace glint::marker_measurement_test {
namespace {

using test::Random;

constexpr MarkerNoise k_declared{0.002, 0.1, 253};

Marker seen_at(const Vector2& pixel, double range_m) {
  int lens_steps = 0;
  const LocalRays rays = local_rays(test::pinhole(), pixel, k_ray_steps_max, lens_steps).value;
  Marker marker;
  marker.ray = rays.ray;
  marker.along_x = rays.along_x;
  marker.along_y = rays.along_y;
  marker.centroid_px = pixel;
  marker.surface_range_m = range_m;
  return marker;
}

// Distance in sigmas of the weighted fit between a point and the measured `marker`, at its range.
double sigmas_off(const Marker& marker, const MarkerNoise& noise, const Vector3& point) {
  const MarkerMeasurementModel sight = measurement_model(marker, marker.surface_range_m, noise);
  const Vector3 model = Vector3::Zero();
  const Result<WeightedMarker> weighed =
      whiten_marker(model, sight.rays, marker.surface_range_m, sight.variance);
  EXPECT_EQ(weighed.reason, Reason::none);
  const WeightedMarker& m = weighed.value;
  const double along = m.ray.dot(point);
  const double off[] = {m.across_first.dot(point) / along, m.across_second.dot(point) / along,
                        (point.norm() - m.range_m) * m.per_range_sigma};
  return Vector3(off[0], off[1], off[2]).norm();
}

TEST(MarkerSight, AddsTheDeclaredNoiseToWhatThePixelsTell) {
  Marker marker = seen_at({300, 200}, 0.5);
  marker.sigma_px = {0.3F, 0.05F};
  marker.range_sigma_m = 0.004F;
  const MarkerVariance variance = measurement_model(marker, 0.5, k_declared).variance;
  EXPECT_NEAR(variance.xx_px2, 0.09 + 0.01, 1e-7);
  EXPECT_NEAR(variance.yy_px2, 0.0025 + 0.01, 1e-7);
  EXPECT_EQ(variance.xy_px2, 0);
  EXPECT_NEAR(variance.range_m2, 16e-6 + 4e-6, 1e-11);
}

TEST(MarkerSight, TakesTheDeclaredNoiseAloneWhereTheMarkersIsNotKnown) {
  const MarkerVariance variance =
      measurement_model(seen_at({300, 200}, 0.5), 0.5, k_declared).variance;
  EXPECT_NEAR(variance.xx_px2, 0.01, 1e-15);
  EXPECT_NEAR(variance.yy_px2, 0.01, 1e-15);
  EXPECT_NEAR(variance.range_m2, 4e-6, 1e-18);
}

TEST(MarkerSight, IsNeverSurerThanItsFloors) {
  for (const double focal_px : {253.0, 0.0}) {
    const MarkerMeasurementModel sight =
        measurement_model(seen_at({300, 200}, 0.5), 0.5, {0, 0, focal_px});
    EXPECT_DOUBLE_EQ(sight.variance.xx_px2, k_pixel_sigma_min_px * k_pixel_sigma_min_px);
    EXPECT_DOUBLE_EQ(sight.variance.yy_px2, k_pixel_sigma_min_px * k_pixel_sigma_min_px);
    EXPECT_DOUBLE_EQ(sight.variance.range_m2, k_range_sigma_min_m * k_range_sigma_min_m);
  }
}

TEST(MarkerSight, TakesTheLensAsTheImageHasIt) {
  const Marker marker = seen_at({450, 60}, 0.5);
  const MarkerMeasurementModel sight = measurement_model(marker, 0.5, k_declared);
  EXPECT_EQ(sight.rays.ray, marker.ray);
  EXPECT_EQ(sight.rays.along_x, marker.along_x);
  EXPECT_EQ(sight.rays.along_y, marker.along_y);
  EXPECT_EQ(sight.rays.pixel, marker.centroid_px);
  // One declared sigma away. Near a pinhole's rim that is a smaller angle than the focal length
  // implies.
  const Vector3 point = 0.5 * unproject(test::pinhole(), {450.1, 60}).value;
  EXPECT_NEAR(sigmas_off(marker, k_declared, point), 1, 0.002);
}

TEST(MarkerSight, GivesAPointWithoutAnImageItsNoiseByTheFocalLength) {
  Random random(1);
  for (int trial = 0; trial < 50; ++trial) {
    Marker marker;
    marker.ray = (random.in_box(2) + Vector3(0, 0, 2)).normalized();
    marker.surface_range_m = random.within(0.2, 1);
    const Vector3 point = marker.surface_range_m * marker.ray;
    const Vector3 across = marker.ray.cross(random.vector(1)).normalized();
    const Vector3 beside = point + across * (0.1 * marker.surface_range_m / 253);
    EXPECT_NEAR(sigmas_off(marker, k_declared, beside), 1, 1e-3);
    EXPECT_NEAR(sigmas_off(marker, k_declared, point + 0.002 * marker.ray), 1, 1e-9);
  }
}

TEST(MarkerSight, TakesAnyFocalLengthThatIsPositive) {
  Marker marker;
  marker.ray = Vector3::UnitZ();
  marker.centroid_px = {31, 42};
  const MarkerMeasurementModel sight = measurement_model(marker, 0.8, {0.002, 0.1, 0.5});
  EXPECT_NEAR(sight.rays.along_x.norm(), 1 / 0.5, 1e-12);
  EXPECT_NEAR(sight.rays.along_y.norm(), 1 / 0.5, 1e-12);
  EXPECT_NEAR(sight.rays.along_x.dot(sight.rays.along_y), 0, 1e-12);
  EXPECT_EQ(sight.rays.pixel, marker.centroid_px);
  EXPECT_NEAR(sight.variance.xx_px2, 0.01, 1e-15);
  // Without a focal length, metres at the marker's range replace pixels.
  const MarkerMeasurementModel metres = measurement_model(marker, 0.8, {0.002, 0.1, 0});
  EXPECT_NEAR(metres.rays.along_x.norm(), 1 / 0.8, 1e-12);
  EXPECT_EQ(metres.variance.xx_px2, metres.variance.range_m2);
  EXPECT_EQ(metres.variance.yy_px2, metres.variance.range_m2);
}

TEST(MarkerSight, GivesAPointWithoutAFocalLengthTheSameNoiseInEveryDirection) {
  Random random(2);
  const MarkerNoise alike{0.001, 0.1, 0};
  for (int trial = 0; trial < 50; ++trial) {
    Marker marker;
    marker.ray = (random.in_box(2) + Vector3(0, 0, 2)).normalized();
    marker.surface_range_m = random.within(0.3, 4);
    const Vector3 off = 0.001 * random.vector(1).normalized();
    EXPECT_NEAR(sigmas_off(marker, alike, marker.surface_range_m * marker.ray + off), 1, 0.005);
  }
}

// By the lens's own rays, and by a pinhole's if the marker has no ray derivatives.
TEST(MarkerSight, FocalLengthMovesTheRayFromTheAxis) {
  Marker marker = seen_at({300, 200}, 0.5);
  MarkerNoise noise = k_declared;
  noise.principal_px = {260, 250};
  EXPECT_TRUE(measurement_model(marker, 0.5, noise)
                  .rays.outward.isApprox(40 * marker.along_x - 50 * marker.along_y));
  marker.along_x = marker.along_y = Vector3::Zero();
  EXPECT_TRUE(measurement_model(marker, 0.5, noise)
                  .rays.outward.isApprox(Vector3(marker.ray.x(), marker.ray.y(), 0)));
}

TEST(MarkerSight, GivesTheSameBitsEverywhere) {
  Random random(3);
  test::BitHash hash;
  for (int trial = 0; trial < 200; ++trial) {
    Marker marker = seen_at({random.within(0, 512), random.within(0, 512)}, 0.5);
    if (trial % 2 == 0) marker.along_x = marker.along_y = Vector3::Zero();
    marker.sigma_px = {0.1F, 0.2F};
    const MarkerMeasurementModel sight = measurement_model(
        marker, random.within(0.2, 1), trial % 3 == 0 ? MarkerNoise{} : k_declared);
    for (int i = 0; i < 3; ++i) hash.add(sight.rays.along_x(i));
    for (int i = 0; i < 3; ++i) hash.add(sight.rays.along_y(i));
    for (const double v : {sight.variance.xx_px2, sight.variance.yy_px2, sight.variance.range_m2})
      hash.add(v);
  }
  EXPECT_EQ(hash.value(), 13921659408146295408u);
}

}  // namespace
}  // namespace glint::marker_measurement_test
