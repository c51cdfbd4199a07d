#include "kernels/pose/ray_table.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <random>
#include <vector>

#include "platform/sensors/camera.hpp"

namespace glint {
namespace {

// The AHAT preset's lens as a table: what a device delivers.
struct Table {
  std::vector<float> rays;
  CameraModel camera = hololens2_ahat().model;

  Table() {
    const CameraModel lens = camera;
    for (int y = 0; y < camera.height; ++y) {
      for (int x = 0; x < camera.width; ++x) {
        const Result<Vector3> ray = unproject(lens, {x + 0.5, y + 0.5});
        for (int i = 0; i < 3; ++i) {
          rays.push_back(ray ? static_cast<float>(ray.value[i]) : 0.0f);
        }
      }
    }
    camera.lens = Lens::lut;
    camera.table = {camera.width, camera.height, rays.data()};
  }
};

const Table& table() {
  static const Table it;
  return it;
}

TEST(RayTable, IsExactAtPixelCentresUpToTheLensCircle) {
  const CameraModel& camera = table().camera;
  int seen = 0;
  for (int y = 0; y < camera.height; ++y) {
    for (int x = 0; x < camera.width; ++x) {
      const float* ray = camera.table.rays + 3 * (y * camera.width + x);
      const Result<Vector3> found = unproject(camera, {x + 0.5, y + 0.5});
      ASSERT_EQ(static_cast<bool>(found), ray[2] > 0) << x << " " << y;
      if (!found) continue;
      ++seen;
      EXPECT_LT((found.value - Vector3(ray[0], ray[1], ray[2])).norm(), 1e-6);
    }
  }
  EXPECT_GT(seen, 200000);
}

TEST(RayTable, AgreesBetweenCentresWithTheLensItWasMadeFrom) {
  const CameraModel lens = hololens2_ahat().model;
  std::mt19937 random(3);
  std::uniform_real_distribution<double> at(60, 450);
  for (int i = 0; i < 2000; ++i) {
    const Vector2 pixel{at(random), at(random)};
    const Result<Vector3> truth = unproject(lens, pixel), found = unproject(table().camera, pixel);
    if (!truth || !found) continue;
    EXPECT_LT((truth.value - found.value).norm(), 2e-5);  // 0.01 mm at 0.5 m
  }
}

TEST(RayTable, FindsThePixelAgain) {
  const CameraModel& camera = table().camera;
  std::mt19937 random(4);
  std::uniform_real_distribution<double> at(0, 512);
  int seen = 0;
  for (int i = 0; i < 5000; ++i) {
    const Vector2 pixel{at(random), at(random)};
    const Result<Vector3> ray = unproject(camera, pixel);
    if (!ray) continue;
    ++seen;
    const Result<Vector2> back = project(camera, 0.7 * ray.value);
    ASSERT_TRUE(back) << pixel.transpose();
    EXPECT_LT((back.value - pixel).norm(), 1e-6);
  }
  EXPECT_GT(seen, 3500);
}

TEST(RayTable, FindsThePixelAlsoFromAPinholesStart) {
  CameraModel camera = table().camera;
  camera.distortion = {};
  for (int y = 40; y < 480; y += 20) {
    for (int x = 40; x < 480; x += 20) {
      const Vector2 pixel{x + 0.3, y + 0.6};
      const Result<Vector3> ray = unproject(camera, pixel);
      if (!ray) continue;
      const Result<Vector2> back = project(camera, ray.value);
      ASSERT_TRUE(back) << pixel.transpose();
      EXPECT_LT((back.value - pixel).norm(), 1e-6);
    }
  }
}

TEST(RayTable, RefusesWhatItDoesNotHold) {
  const CameraModel& camera = table().camera;
  EXPECT_FALSE(unproject(camera, {1, 1}));
  EXPECT_FALSE(unproject(camera, {-0.1, 256}));
  EXPECT_FALSE(unproject(camera, {512.1, 256}));
  EXPECT_FALSE(unproject(camera, {NAN, 256}));
  EXPECT_FALSE(project(camera, {2, 0, 1}));
  EXPECT_FALSE(project(camera, {1, 1, 0.1}));
  EXPECT_FALSE(project(camera, {0, 0, -1}));
  CameraModel empty = camera;
  empty.table = {};
  EXPECT_FALSE(unproject(empty, {256, 256}));
  EXPECT_FALSE(project(empty, {0, 0, 1}));
}

TEST(RayTable, OfARealDeviceIsFoundAgainAndNearThePreset) {
  const char* data = std::getenv("GLINT_TEST_DATA");
  const std::string path =
      std::string(data ? data : "") + "/hololens2_ahat_lut/ahat_lut_512x512x3_float32.npy";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << "no real table at GLINT_TEST_DATA";
  const Camera preset = hololens2_ahat(), camera = with_ray_table(preset, path);
  double square = 0;
  int valid = 0;
  for (int y = 0; y < 512; ++y) {
    for (int x = 0; x < 512; ++x) {
      const Vector2 pixel{x + 0.5, y + 0.5};
      const Result<Vector3> ray = unproject(camera.model, pixel);
      if (!ray) continue;
      ++valid;
      const Result<Vector2> fitted = project(preset.model, ray.value);
      ASSERT_TRUE(fitted);
      square += (fitted.value - pixel).squaredNorm() / 2;
      // At the lens circle's very rim the search has no slopes to follow.
      const bool rim = !unproject(camera.model, pixel + Vector2(1, 1)) ||
                       !unproject(camera.model, pixel - Vector2(1, 1)) ||
                       !unproject(camera.model, pixel + Vector2(1, -1)) ||
                       !unproject(camera.model, pixel + Vector2(-1, 1));
      if ((x + y) % 17 != 0 || rim) continue;
      const Result<Vector2> back = project(camera.model, ray.value);
      ASSERT_TRUE(back) << pixel.transpose();
      EXPECT_LT((back.value - pixel).norm(), 1e-6);
    }
  }
  EXPECT_EQ(valid, 209594);
  EXPECT_LT(std::sqrt(square / valid), 0.065);
}

}  // namespace
}  // namespace glint
