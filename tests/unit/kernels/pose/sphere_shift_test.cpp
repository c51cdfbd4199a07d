#include "kernels/pose/sphere_shift.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "platform/formats/camera.hpp"

namespace glint {
namespace {

CameraModel pinhole() {
  CameraModel camera;
  camera.width = camera.height = 700;
  camera.fx = camera.fy = 253;
  camera.cx = camera.cy = 350;
  return camera;
}

// Image centroid of the sphere: mean of all positions whose ray meets it, on a grid of 0.1 px.
Vector2 image_centroid(const CameraModel& camera, const Vector3& centre, double radius_m) {
  const Vector2 about = project(camera, centre).value;
  const double least = std::sqrt(1 - std::pow(radius_m / centre.norm(), 2));
  Vector2 sum = Vector2::Zero();
  double count = 0;
  for (int j = -150; j <= 150; ++j) {
    for (int i = -150; i <= 150; ++i) {
      const Vector2 pixel = about + Vector2(0.1 * i, 0.1 * j);
      const Result<Vector3> ray = unproject(camera, pixel);
      if (!ray || ray.value.dot(centre.normalized()) < least) continue;
      sum += pixel;
      ++count;
    }
  }
  return sum / count;
}

Vector3 at_angle(double degrees, double azimuth, double range_m) {
  const double angle = degrees * 3.14159265358979323846 / 180;
  return range_m * Vector3(std::sin(angle) * std::cos(azimuth), std::sin(angle) * std::sin(azimuth),
                           std::cos(angle));
}

// f a^2 tan(t) / cos^2(t): to second order, the ellipse's centre between its two rims.
TEST(SphereShift, OfAPinholeIsThatOfTheSilhouettesEllipse) {
  const SphereOffset shift = sphere_offset(pinhole());
  for (const double degrees : {3.0, 10.0, 25.0, 45.0}) {
    const double angle = degrees * 3.14159265358979323846 / 180;
    const double sine = 0.006 / 0.4, half = std::asin(sine);
    const double ellipse =
        253 * (0.5 * (std::tan(angle + half) + std::tan(angle - half)) - std::tan(angle));
    const Vector2 pixel(350, 350 + 253 * std::tan(angle));
    const Vector2 moved = offset_px(shift, pixel, sine);
    EXPECT_NEAR(moved.x(), 0, 1e-12) << degrees;
    EXPECT_NEAR(moved.y(), ellipse, 0.002 + 0.01 * ellipse) << degrees;
  }
}

// Without the correction the centroids of these spheres are up to 0.19 px off, for the pinhole.
TEST(SphereShift, MovesTheMiddleOfWhatIsSeenToTheCentreForEveryLens) {
  const CameraModel lenses[] = {pinhole(), hololens1_short_throw().model, hololens2_ahat().model};
  for (const CameraModel& camera : lenses) {
    const SphereOffset shift = sphere_offset(camera);
    for (const double degrees : {10.0, 30.0, 40.0}) {
      for (const double azimuth : {0.3, 2.0, 4.0}) {
        const Vector3 centre = at_angle(degrees, azimuth, 0.3);
        const Vector2 middle = image_centroid(camera, centre, 0.006);
        const Vector2 corrected = middle - offset_px(shift, middle, 0.006 / 0.3);
        EXPECT_LT((corrected - project(camera, centre).value).norm(), 0.012)
            << static_cast<int>(camera.lens) << " " << degrees << " " << azimuth;
      }
    }
  }
}

TEST(SphereShift, OfATableIsThatOfItsLens) {
  const Camera camera = hololens2_ahat();
  std::vector<float> rays;
  for (int y = 0; y < 512; ++y) {
    for (int x = 0; x < 512; ++x) {
      const Result<Vector3> ray = unproject(camera.model, {x + 0.5, y + 0.5});
      for (int i = 0; i < 3; ++i) rays.push_back(ray ? static_cast<float>(ray.value[i]) : 0);
    }
  }
  CameraModel table = camera.model;
  table.lens = Lens::lut;
  table.table = {512, 512, rays.data()};
  const SphereOffset a = sphere_offset(camera.model), b = sphere_offset(table);
  for (const double x : {260.0, 300.0, 380.0, 470.0}) {
    const Vector2 apart = offset_px(a, {x, 300}, 0.02) - offset_px(b, {x, 300}, 0.02);
    EXPECT_LT(apart.norm(), 0.005) << x;
  }
}

// Position far outside, a lens without rays, a camera without a size: the result is finite.
TEST(SphereShift, IsANumberWhateverTheCamera) {
  CameraModel nothing;
  CameraModel without_rays = hololens2_ahat().model;
  without_rays.lens = Lens::lut;
  without_rays.table = {};
  for (const CameraModel& camera : {nothing, without_rays, pinhole()}) {
    const SphereOffset shift = sphere_offset(camera);
    for (const double place : {-1e6, 0.0, 350.0, 1e6}) {
      for (const double sine : {0.0, 0.01, 1.0}) {
        const Vector2 moved = offset_px(shift, {place, -place}, sine);
        EXPECT_TRUE(std::isfinite(moved.x()) && std::isfinite(moved.y())) << place;
      }
    }
  }
  EXPECT_EQ(offset_px({}, {100, 100}, 0.02), Vector2(0, 0));
}

// f tan(t) / cos^2(t): the gain is 1 / cos^2(t) per unit of distance, at each table entry.
TEST(SphereShift, GainOfAPinholeIsTheSquareOfTheSecant) {
  CameraModel camera = pinhole();
  camera.width = 700;
  camera.height = 500;
  camera.cx = 200;
  camera.cy = 350;
  const SphereOffset shift = sphere_offset(camera);
  EXPECT_EQ(shift.axis_px, Vector2(200, 350));
  const double square = 500.0 * 500 + 350.0 * 350;  // of the farthest corner
  EXPECT_DOUBLE_EQ(shift.entries_per_square_px, (k_sphere_shift_entries - 1) / square);
  for (int i = 0; i < k_sphere_shift_entries; ++i) {
    const double h = std::max(std::sqrt(i * square / (k_sphere_shift_entries - 1)), 24.0);
    const double secant_square = 1 + h * h / (253 * 253);
    EXPECT_NEAR(shift.gain[static_cast<std::size_t>(i)] / secant_square, 1, 0.01) << i;
  }
}

// A table with known entries: equal steps of the squared distance, constant beyond the last.
TEST(SphereShift, InterpolatesItsTableByTheSquaredDistance) {
  SphereOffset shift;
  shift.axis_px = {30, 40};
  shift.entries_per_square_px = 0.01;
  for (std::size_t i = 0; i < k_sphere_shift_entries; ++i)
    shift.gain[i] = 1 + static_cast<double>(i * i);
  const auto gain_at = [&](double x, double y) {
    const Vector2 moved = offset_px(shift, {30 + x, 40 + y}, 0.1);
    EXPECT_NEAR(moved.x() * y, moved.y() * x, 1e-6) << "along the line from the axis";
    return moved.dot(Vector2(x, y)) / (0.01 * (x * x + y * y));
  };
  EXPECT_NEAR(gain_at(10, 0), 2, 1e-12);
  EXPECT_NEAR(gain_at(0, -20), 17, 1e-12);
  EXPECT_NEAR(gain_at(-6, 8), 2, 1e-12);
  EXPECT_NEAR(gain_at(5, 0), 1.25, 1e-12) << "a quarter of the first step";
  EXPECT_NEAR(gain_at(15, 5), 0.5 * (5 + 10), 1e-12) << "between two and three";
  const double last = k_sphere_shift_entries - 1;
  EXPECT_NEAR(gain_at(std::sqrt(100 * last), 0), 1 + last * last, 1e-9);
  EXPECT_NEAR(gain_at(std::sqrt(100 * (last - 0.5)), 0),
              0.5 * (2 + last * last + (last - 1) * (last - 1)), 1e-9);
  EXPECT_NEAR(gain_at(500, 900), 1 + last * last, 1e-9);
}

// Bits of g++ -O3 and clang++ -O1 on x86-64 and of g++ on arm64.
TEST(SphereShift, HasTheSameBitsEverywhere) {
  const Vector2 moved =
      offset_px(sphere_offset(hololens1_short_throw().model), {400.25, 300.5}, 0.02);
  EXPECT_EQ(moved.x(), 0x1.388c6b358781ap-4);
  EXPECT_EQ(moved.y(), 0x1.0bc5a59044296p-5);
}

}  // namespace
}  // namespace glint
