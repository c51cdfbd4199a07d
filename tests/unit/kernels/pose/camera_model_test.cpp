#include "kernels/pose/camera_model.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <opencv2/calib3d.hpp>
#include <random>

#include "platform/formats/camera.hpp"

namespace glint {
namespace {

std::vector<CameraModel> polynomial_lenses() {
  CameraModel pinhole = hololens1_short_throw().model;
  pinhole.lens = Lens::pinhole;
  return {pinhole, hololens1_short_throw().model, hololens2_ahat().model};
}

std::vector<double> opencv_distortion(const CameraModel& camera) {
  if (camera.lens == Lens::pinhole) return {0, 0, 0, 0, 0};
  const auto& k = camera.distortion;
  if (camera.lens == Lens::brown) return {k.begin(), k.begin() + 5};
  return {k.begin(), k.end()};
}

// OpenCV's pixel origin is the first pixel's centre, Glint's is its corner.
cv::Matx33d opencv_matrix(const CameraModel& c) {
  return {c.fx, 0, c.cx - 0.5, 0, c.fy, c.cy - 0.5, 0, 0, 1};
}

// A random point inside the frame and the lens's field.
Vector3 random_point(const CameraModel& camera, std::mt19937& random) {
  std::uniform_real_distribution<double> part(0, 1);
  while (true) {
    const Result<Vector3> ray =
        unproject(camera, {camera.width * part(random), camera.height * part(random)});
    if (ray) return ray.value * (0.2 + part(random));
  }
}

TEST(CameraModel, ProjectsAsOpenCvDoes) {
  for (const CameraModel& camera : polynomial_lenses()) {
    std::mt19937 random(1);
    std::vector<cv::Point3d> points;
    for (int i = 0; i < 2000; ++i) {
      const Vector3 p = random_point(camera, random);
      points.emplace_back(p.x(), p.y(), p.z());
    }
    std::vector<cv::Point2d> expected;
    cv::projectPoints(points, cv::Vec3d::zeros(), cv::Vec3d::zeros(), opencv_matrix(camera),
                      opencv_distortion(camera), expected);
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Result<Vector2> pixel = project(camera, {points[i].x, points[i].y, points[i].z});
      ASSERT_TRUE(pixel);
      EXPECT_NEAR(pixel.value.x(), expected[i].x + 0.5, 1e-6);
      EXPECT_NEAR(pixel.value.y(), expected[i].y + 0.5, 1e-6);
    }
  }
}

// All parameters differ, and none of the distortion coefficients is small.
CameraModel skewed_lens(Lens kind) {
  CameraModel camera;
  camera.lens = kind;
  camera.width = 640;
  camera.height = 400;
  camera.fx = 310;
  camera.fy = 270;
  camera.cx = 330;
  camera.cy = 190;
  camera.distortion = {0.11, -0.07, 0.013, -0.021, 0.03, 0.17, 0.05, -0.02};
  return camera;
}

TEST(CameraModel, ProjectsThroughEveryTermOfTheDistortionAsOpenCvDoes) {
  for (const Lens kind : {Lens::pinhole, Lens::brown, Lens::rational}) {
    const CameraModel camera = skewed_lens(kind);
    std::mt19937 random(4);
    std::vector<cv::Point3d> points;
    for (int i = 0; i < 500; ++i) {
      const Vector3 p = random_point(camera, random);
      points.emplace_back(p.x(), p.y(), p.z());
    }
    std::vector<cv::Point2d> expected;
    cv::projectPoints(points, cv::Vec3d::zeros(), cv::Vec3d::zeros(), opencv_matrix(camera),
                      opencv_distortion(camera), expected);
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Vector3 point{points[i].x, points[i].y, points[i].z};
      const Result<Vector2> pixel = project(camera, point);
      ASSERT_TRUE(pixel);
      EXPECT_NEAR(pixel.value.x(), expected[i].x + 0.5, 1e-6);
      EXPECT_NEAR(pixel.value.y(), expected[i].y + 0.5, 1e-6);
      const Result<Vector3> ray = unproject(camera, pixel.value);
      ASSERT_TRUE(ray);
      EXPECT_LT((ray.value - point.normalized()).norm(), 1e-9);
      // Derivatives of the ray by the pixel, against differences.
      int steps = 0;
      const RayJacobian turning =
          unproject_with_jacobian(camera, pixel.value, k_ray_steps_max, steps).value;
      const auto beside = [&](double dx, double dy) {
        return unproject(camera, pixel.value + Vector2{dx, dy}).value;
      };
      EXPECT_LT((turning.along_x - (beside(0.01, 0) - beside(-0.01, 0)) / 0.02).norm(), 1e-8);
      EXPECT_LT((turning.along_y - (beside(0, 0.01) - beside(0, -0.01)) / 0.02).norm(), 1e-8);
    }
  }
}

// The largest angle inside the lens's field, and just beyond it.
TEST(CameraModel, EndsAtItsField) {
  for (const Lens kind : {Lens::brown, Lens::rational}) {
    CameraModel camera = skewed_lens(kind);
    camera.distortion = {0.01, 0, 0, 0, 0, 0, 0, 0};
    camera.field_tangent_max = 0.5;
    for (const Vector2& side : {Vector2(1, 0), Vector2(0, -1), Vector2(0.6, -0.8)}) {
      const Vector2 inside = 0.4999 * side, outside = 0.5001 * side;
      const Result<Vector2> pixel = project(camera, {inside.x(), inside.y(), 1});
      EXPECT_TRUE(pixel);
      EXPECT_TRUE(unproject(camera, pixel.value));
      EXPECT_EQ(project(camera, {outside.x(), outside.y(), 1}).reason, Reason::out_of_range);
      CameraModel wider = camera;
      wider.field_tangent_max = 0;
      const Vector2 beyond = project(wider, {outside.x(), outside.y(), 1}).value;
      EXPECT_EQ(unproject(camera, beyond).reason, Reason::out_of_range);
      int steps = 0;
      EXPECT_FALSE(unproject_with_jacobian(camera, beyond, k_ray_steps_max, steps));
    }
  }
}

// The search succeeds with exactly the needed steps and fails with one less; counts accumulate.
TEST(CameraModel, CountsTheStepsOfASearchForARay) {
  const CameraModel camera = skewed_lens(Lens::rational);
  int needed = 100;
  ASSERT_TRUE(unproject_with_jacobian(camera, {500, 300}, k_ray_steps_max, needed));
  needed -= 100;
  EXPECT_GE(needed, 2);
  int taken = 0;
  EXPECT_TRUE(unproject_with_jacobian(camera, {500, 300}, needed, taken));
  EXPECT_EQ(taken, needed);
  EXPECT_FALSE(unproject_with_jacobian(camera, {500, 300}, needed - 1, taken));
  EXPECT_EQ(taken, 2 * needed - 1);
  EXPECT_FALSE(unproject_with_jacobian(camera, {500, 300}, 0, taken));
  EXPECT_EQ(taken, 2 * needed - 1);
  EXPECT_TRUE(unproject_with_jacobian(skewed_lens(Lens::pinhole), {500, 300}, 0, taken));
  EXPECT_EQ(taken, 2 * needed - 1) << "a pinhole takes none";
}

// The initial guess is at a fold of the lens, where the Jacobian is singular: the search ends at
// once.
TEST(CameraModel, EndsItsSearchWhereTheLensFolds) {
  CameraModel camera = skewed_lens(Lens::brown);
  // 1 - 16 r^2 + 15 r^4 is 0 at r = 1, which is four times the distorted radius.
  camera.distortion = {-16, 15, 0, 0, 0, 0, 0, 0};
  int steps = 0;
  const Vector2 pixel{camera.cx + 0.25 * camera.fx, camera.cy};
  EXPECT_EQ(unproject_with_jacobian(camera, pixel, k_ray_steps_max, steps).reason,
            Reason::out_of_range);
  EXPECT_EQ(steps, 1);
}

// Within 45 degrees: further out OpenCV's fixed-point iteration does not converge to 1e-6 px.
TEST(CameraModel, UnprojectsAsOpenCvDoes) {
  for (const CameraModel& camera : polynomial_lenses()) {
    std::mt19937 random(2);
    for (int i = 0; i < 500; ++i) {
      const Vector3 point = random_point(camera, random);
      if (point.head<2>().norm() > point.z()) continue;
      const Vector2 pixel = project(camera, point).value;
      std::vector<cv::Point2d> distorted{{pixel.x() - 0.5, pixel.y() - 0.5}}, expected;
      cv::undistortPoints(
          distorted, expected, opencv_matrix(camera), opencv_distortion(camera), cv::noArray(),
          cv::noArray(),
          cv::TermCriteria(cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 500, 1e-12));
      const Result<Vector3> ray = unproject(camera, pixel);
      ASSERT_TRUE(ray);
      EXPECT_NEAR(camera.fx * ray.value.x() / ray.value.z(), camera.fx * expected[0].x, 1e-6);
      EXPECT_NEAR(camera.fy * ray.value.y() / ray.value.z(), camera.fy * expected[0].y, 1e-6);
    }
  }
}

TEST(CameraModel, FindsEveryPixelOfTheFrameAgain) {
  for (const CameraModel& camera : polynomial_lenses()) {
    int seen = 0;
    for (int y = 0; y < camera.height; y += 7) {
      for (int x = 0; x < camera.width; x += 7) {
        const Vector2 pixel{x + 0.25, y + 0.75};
        const Result<Vector3> ray = unproject(camera, pixel);
        if (!ray) continue;  // outside the lens circle
        ++seen;
        EXPECT_NEAR(ray.value.norm(), 1, 1e-12);
        const Result<Vector2> back = project(camera, 0.4 * ray.value);
        ASSERT_TRUE(back);
        EXPECT_LT((back.value - pixel).norm(), 1e-6);
      }
    }
    // The AHAT lens maps 0.80 of its frame, the others all of it.
    const double part = seen * 49.0 / (camera.width * camera.height);
    EXPECT_GT(part, camera.lens == Lens::rational ? 0.78 : 0.98);
  }
}

// Lenses wider than the presets: for the rational one the initial guess is far off, the other folds
// back within the frame.
std::vector<CameraModel> wide_lenses() {
  CameraModel rational;
  rational.lens = Lens::rational;
  rational.width = rational.height = 512;
  rational.fx = rational.fy = 200;
  rational.cx = rational.cy = 256;
  rational.distortion = {6, 3.5, 0, 0, 0.18, 6.35, 5.4, 1};
  CameraModel brown = rational;
  brown.lens = Lens::brown;
  brown.distortion = {-0.35, 0.12};
  return {rational, brown};
}

TEST(CameraModel, TurnsEveryPixelThatHasARayIntoIt) {
  std::vector<CameraModel> lenses = polynomial_lenses();
  for (const CameraModel& wide : wide_lenses()) lenses.push_back(wide);
  for (const CameraModel& camera : lenses) {
    int rays = 0;
    for (int y = 0; y <= camera.height; y += 2) {
      for (int x = 0; x <= camera.width; x += 2) {
        const Vector2 pixel{x + 0.3, y + 0.6};
        const Result<Vector3> ray = unproject(camera, pixel);
        int steps = 0;
        const Result<RayJacobian> turning =
            unproject_with_jacobian(camera, pixel, k_ray_steps_max, steps);
        ASSERT_EQ(turning.reason, ray.reason) << pixel.transpose();
        if (!ray) continue;
        ++rays;
        EXPECT_LT((turning.value.ray - ray.value).norm(), 1e-15);
        EXPECT_LT((project(camera, ray.value).value - pixel).norm(), 1e-9);
      }
    }
    EXPECT_GT(rays, 1000);
  }
}

// The search takes no extra step to confirm convergence.
TEST(CameraModel, TakesAtMostFiveStepsThroughTheLensesThatWeShip) {
  for (const CameraModel& camera : polynomial_lenses()) {
    for (int y = 0; y <= camera.height; y += 2) {
      for (int x = 0; x <= camera.width; x += 2) {
        int steps = 0;
        if (!unproject_with_jacobian(camera, {x + 0.3, y + 0.6}, k_ray_steps_max, steps)) continue;
        ASSERT_LE(steps, 5) << x << ", " << y;
      }
    }
  }
}

TEST(CameraModel, TurnsARayAsItsNeighboursLie) {
  for (const CameraModel& camera : polynomial_lenses()) {
    const Vector2 pixels[] = {{camera.cx, camera.cy}, {150.2, 180.9}, {300.5, 60.1}};
    for (const Vector2& pixel : pixels) {
      int steps = 0;
      const RayJacobian turning =
          unproject_with_jacobian(camera, pixel, k_ray_steps_max, steps).value;
      const auto ray = [&](double dx, double dy) {
        return unproject(camera, pixel + Vector2{dx, dy}).value;
      };
      const double h = 0.01;
      EXPECT_LT((turning.along_x - (ray(h, 0) - ray(-h, 0)) / (2 * h)).norm(), 1e-9);
      EXPECT_LT((turning.along_y - (ray(0, h) - ray(0, -h)) / (2 * h)).norm(), 1e-9);
    }
  }
}

TEST(CameraModel, IsTheSeedsPinhole) {
  CameraModel camera = polynomial_lenses()[0];
  const double range_z = 0.5;
  const Vector3 ray = unproject(camera, {camera.cx + 40, camera.cy - 30}).value;
  const Vector3 point = ray * (range_z / ray.z());  // m = (Z x / f, Z y / f, Z)
  EXPECT_NEAR(point.x(), range_z * 40 / camera.fx, 1e-15);
  EXPECT_NEAR(point.y(), range_z * -30 / camera.fy, 1e-15);
}

TEST(CameraModel, RefusesWhatLiesBehindOrOutsideTheLens) {
  for (const CameraModel& camera : polynomial_lenses()) {
    EXPECT_EQ(project(camera, {0, 0, -1}).reason, Reason::out_of_range);
    EXPECT_EQ(project(camera, {0, 0, 0}).reason, Reason::out_of_range);
    EXPECT_EQ(project(camera, {NAN, 0, 1}).reason, Reason::out_of_range);
    EXPECT_EQ(project(camera, {1, 0, 1e-9}).reason, Reason::out_of_range);
    EXPECT_EQ(unproject(camera, {NAN, 1}).reason, Reason::out_of_range);
    EXPECT_EQ(unproject(camera, {1e9, 1}).reason, Reason::out_of_range);
  }
  const CameraModel ahat = hololens2_ahat().model;
  EXPECT_EQ(unproject(ahat, {2, 2}).reason, Reason::out_of_range);   // outside the lens circle
  EXPECT_EQ(project(ahat, {2, 0, 1}).reason, Reason::out_of_range);  // 63 degrees off the axis
}

// r - 0.5 r^3 has its maximum at r = 0.816: a point beyond would share a pixel with a nearer one.
TEST(CameraModel, RefusesRaysBeyondThePolynomialsTurningPoint) {
  CameraModel camera = hololens1_short_throw().model;
  camera.distortion = {-0.5, 0, 0, 0, 0, 0, 0, 0};
  camera.field_tangent_max = 0;
  EXPECT_TRUE(project(camera, {0.80, 0, 1}));
  EXPECT_FALSE(project(camera, {0.83, 0, 1}));
  for (int x = 0; x <= 600; ++x) {
    const Result<Vector3> ray = unproject(camera, {x + 0.5, camera.cy});
    if (ray) {
      EXPECT_LT(std::abs(ray.value.x() / ray.value.z()), 0.8165);
    }
  }
  EXPECT_FALSE(unproject(camera, {camera.cx + camera.fx * 0.6, camera.cy}));
}

// Bits are equal on every machine, compiler and optimisation level.
TEST(CameraModel, GivesTheSameBitsEverywhere) {
  std::uint64_t hash = 14695981039346656037u;  // FNV-1a
  for (const CameraModel& camera : polynomial_lenses()) {
    for (int i = 0; i < 64; ++i) {
      const Vector3 ray = unproject(camera, {100.3 + 5 * i, 90.7 + 4 * i}).value;
      const Vector2 pixel = project(camera, {ray.x() + 0.01, ray.y(), ray.z()}).value;
      for (const double value : {ray.x(), ray.y(), ray.z(), pixel.x(), pixel.y()}) {
        hash = (hash ^ std::bit_cast<std::uint64_t>(value)) * 1099511628211u;
      }
    }
  }
  EXPECT_EQ(hash, 5584614025142010643u);
}

}  // namespace
}  // namespace glint
