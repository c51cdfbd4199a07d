#include "kernels/pose/local_rays.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "platform/formats/camera.hpp"

namespace glint {
namespace {

CameraModel wide_lens() {
  CameraModel camera = hololens2_ahat().model;
  camera.fx = camera.fy = 200;
  camera.distortion = {6, 3.5, 0, 0, 0.18, 6.35, 5.4, 1};
  camera.field_tangent_max = 0;
  return camera;
}

// Half a pixel from the pixels that ray_steps_needed() tests, over the whole frame.
int rays_missing(const CameraModel& camera, int steps_max) {
  int lost = 0;
  for (int y = 0; y < camera.height; y += 3) {
    for (int x = 0; x < camera.width; x += 3) {
      const Vector2 pixel{x + 0.5, y + 0.5};
      int taken = 0;
      const bool has_one = static_cast<bool>(unproject(camera, pixel));
      lost += has_one && !local_rays(camera, pixel, steps_max, taken) ? 1 : 0;
    }
  }
  return lost;
}

// Lens table of 9 x 7 rays; those beyond a column are missing.
struct RimTable {
  std::vector<float> rays;
  CameraModel camera;

  explicit RimTable(int columns) {
    camera.width = 9;
    camera.height = 7;
    camera.fx = 40;
    camera.fy = 30;
    camera.cx = 4;
    camera.cy = 3;
    for (int y = 0; y < 7; ++y) {
      for (int x = 0; x < 9; ++x) {
        const Vector3 ray = unproject(camera, {x + 0.5, y + 0.5}).value;
        for (int i = 0; i < 3; ++i) rays.push_back(x < columns ? static_cast<float>(ray(i)) : 0);
      }
    }
    camera.lens = Lens::lut;
    camera.table = {9, 7, rays.data()};
  }
};

// Differences to the next pixel on the right and below, at the rim to the previous one.
TEST(LocalRays, OfATableAreThoseOfItsNeighbours) {
  const RimTable whole(9), cut(5);
  CameraModel pinhole = whole.camera;
  pinhole.lens = Lens::pinhole;
  for (const CameraModel& camera : {whole.camera, cut.camera}) {
    for (const double x : {0.5, 2.5, 4.5}) {
      for (const double y : {0.5, 3.5, 6.5}) {
        const Vector2 pixel{x, y};
        int steps = 7, none = 0;
        const Result<LocalRays> local = local_rays(camera, pixel, 0, steps);
        ASSERT_TRUE(local);
        const LocalRays& rays = local.value;
        const RayJacobian truth = unproject_with_jacobian(pinhole, pixel, 0, none).value;
        EXPECT_EQ(rays.pixel, pixel);
        EXPECT_LT((rays.ray - truth.ray).norm(), 1e-6);
        EXPECT_LT((rays.along_x - truth.along_x).norm(), 0.1 * truth.along_x.norm());
        EXPECT_LT((rays.along_y - truth.along_y).norm(), 0.1 * truth.along_y.norm());
        EXPECT_NEAR(rays.along_x.dot(rays.ray), 0, 1e-12);
        EXPECT_NEAR(rays.along_y.dot(rays.ray), 0, 1e-12);
        // The focal length moves the ray in proportion to its distance from the axis.
        EXPECT_TRUE(rays.outward.isApprox(rays.along_x * (x - 4) + rays.along_y * (y - 3)));
        EXPECT_EQ(steps, 7 + 3 * k_lens_steps_per_table_ray);
        EXPECT_NEAR(rays.steradian_per_pixel(), rays.along_x.cross(rays.along_y).norm(), 1e-15);
        EXPECT_TRUE(rays.perpendicular_offset(pixel + Vector2(2, -3))
                        .isApprox(2 * rays.along_x - 3 * rays.along_y));
      }
    }
  }
}

TEST(LocalRays, OfATableAreNoneWhereItHasNoRayAndStandWhereNoNeighbourHasOne) {
  int steps = 0;
  EXPECT_EQ(local_rays(RimTable(5).camera, {6.5, 3.5}, 0, steps).reason, Reason::out_of_range);
  EXPECT_EQ(steps, 0);
  const RimTable column(1);
  const Result<LocalRays> alone = local_rays(column.camera, {0.5, 3.5}, 0, steps);
  ASSERT_TRUE(alone);
  EXPECT_TRUE(alone.value.along_x.isZero());
  EXPECT_GT(alone.value.along_y.norm(), 0.01);
  EXPECT_EQ(steps, 2 * k_lens_steps_per_table_ray);
}

TEST(LocalRays, OfAPolynomialAreItsTurningRays) {
  const CameraModel camera = wide_lens();
  const Vector2 pixel{300.25, 200.5};
  int a = 0, b = 0;
  const LocalRays rays = local_rays(camera, pixel, k_ray_steps_max, a).value;
  const RayJacobian turning = unproject_with_jacobian(camera, pixel, k_ray_steps_max, b).value;
  EXPECT_EQ(rays.pixel, pixel);
  EXPECT_EQ(rays.ray, turning.ray);
  EXPECT_EQ(rays.along_x, turning.along_x);
  EXPECT_EQ(rays.along_y, turning.along_y);
  EXPECT_TRUE(rays.outward.isApprox(turning.along_x * (300.25 - camera.cx) +
                                    turning.along_y * (200.5 - camera.cy)));
  EXPECT_EQ(a, b);
  EXPECT_EQ(local_rays(camera, pixel, 1, a).reason, Reason::out_of_range);
}

TEST(RayStepsNeeded, IsOneMoreThanTheLensTakes) {
  EXPECT_EQ(ray_steps_needed(hololens2_ahat().model), 6);
  EXPECT_LE(ray_steps_needed(hololens1_short_throw().model), 6);
  CameraModel pinhole = hololens1_short_throw().model;
  pinhole.lens = Lens::pinhole;
  EXPECT_EQ(ray_steps_needed(pinhole), 0);
  EXPECT_GT(ray_steps_needed(wide_lens()), 12);
}

// Principal point in a corner: the rays with the most steps are in the opposite one, for each
// corner.
TEST(RayStepsNeeded, LooksAtTheWholeFrame) {
  CameraModel camera = wide_lens();
  camera.width = 400;
  camera.height = 240;
  camera.cx = 200;
  camera.cy = 120;
  const int middle = ray_steps_needed(camera);
  int needed = 0;
  for (const double x : {0.0, 400.0}) {
    for (const double y : {0.0, 240.0}) {
      camera.cx = x;
      camera.cy = y;
      const int steps = ray_steps_needed(camera);
      EXPECT_GT(steps, middle);
      if (needed == 0) needed = steps;
      EXPECT_EQ(steps, needed) << x << " " << y;
      EXPECT_EQ(rays_missing(camera, steps), 0);
    }
  }
}

TEST(RayStepsNeeded, LosesNoRayThatTheLensHas) {
  for (const CameraModel& camera :
       {hololens2_ahat().model, hololens1_short_throw().model, wide_lens()}) {
    EXPECT_EQ(rays_missing(camera, ray_steps_needed(camera)), 0);
  }
  EXPECT_GT(rays_missing(wide_lens(), 6), 1000);
}

TEST(RayStepsNeeded, AreThoseOfLookUpsForATable) {
  CameraModel camera = hololens2_ahat().model;
  camera.lens = Lens::lut;
  EXPECT_EQ(ray_steps_needed(camera), k_table_ray_steps);
}

}  // namespace
}  // namespace glint
