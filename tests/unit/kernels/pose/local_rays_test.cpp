#include "kernels/pose/local_rays.hpp"

#include <gtest/gtest.h>

#include "platform/sensors/camera.hpp"

namespace glint {
namespace {

CameraModel wide_lens() {
  CameraModel camera = hololens2_ahat().model;
  camera.fx = camera.fy = 200;
  camera.distortion = {6, 3.5, 0, 0, 0.18, 6.35, 5.4, 1};
  camera.field_tangent_max = 0;
  return camera;
}

// Half a pixel beside the pixels that were asked, all over the frame.
int rays_lost(const CameraModel& camera, int steps_max) {
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

TEST(RayStepsNeeded, IsOneMoreThanTheLensTakes) {
  EXPECT_EQ(ray_steps_needed(hololens2_ahat().model), 6);
  EXPECT_LE(ray_steps_needed(hololens1_short_throw().model), 6);
  CameraModel pinhole = hololens1_short_throw().model;
  pinhole.lens = Lens::pinhole;
  EXPECT_EQ(ray_steps_needed(pinhole), 0);
  EXPECT_GT(ray_steps_needed(wide_lens()), 12);
}

TEST(RayStepsNeeded, LosesNoRayThatTheLensHas) {
  for (const CameraModel& camera :
       {hololens2_ahat().model, hololens1_short_throw().model, wide_lens()}) {
    EXPECT_EQ(rays_lost(camera, ray_steps_needed(camera)), 0);
  }
  EXPECT_GT(rays_lost(wide_lens(), 6), 1000);
}

TEST(RayStepsNeeded, AreThoseOfLookUpsForATable) {
  CameraModel camera = hololens2_ahat().model;
  camera.lens = Lens::lut;
  EXPECT_EQ(ray_steps_needed(camera), k_table_ray_steps);
}

}  // namespace
}  // namespace glint
