#include "kernels/pose/ray_table.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <random>
#include <utility>
#include <vector>

#include "platform/formats/camera.hpp"

namespace glint {
namespace {

// The AHAT preset's lens as a table, the form in which a device delivers it.
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

// A plane of rays, some of them missing: bilinear interpolation between four.
struct SmallTable {
  static constexpr int k_width = 6, k_height = 4;
  std::vector<float> rays;
  RayTable table{k_width, k_height, nullptr};

  SmallTable() {
    for (int y = 0; y < k_height; ++y)
      for (int x = 0; x < k_width; ++x)
        for (const double part : {0.1 * x + 0.01 * x * y, 0.07 * y, 1.0 + 0.02 * x * y})
          rays.push_back(static_cast<float>(part));
    table.rays = rays.data();
  }
  [[nodiscard]] Vector3 at(double x, double y) const {
    return Vector3(0.1 * x + 0.01 * x * y, 0.07 * y, 1 + 0.02 * x * y).normalized();
  }
  void remove(int x, int y) {
    for (int i = 0; i < 3; ++i) rays[static_cast<std::size_t>(3 * (y * k_width + x) + i)] = 0;
  }
};

// These rays are bilinear in the pixel, so the table is exact everywhere. Beyond the outermost
// centres the nearest cell is extrapolated.
TEST(RayTable, IsBilinearBetweenItsRaysAndGoesOnToItsBorder) {
  const SmallTable small;
  for (double y = 0; y <= 4; y += 0.25) {
    for (double x = 0; x <= 6; x += 0.25) {
      const Result<Vector3> ray = unproject(small.table, {x, y});
      ASSERT_TRUE(ray) << x << " " << y;
      EXPECT_LT((ray.value - small.at(x - 0.5, y - 0.5)).norm(), 1e-6) << x << " " << y;
    }
  }
  for (const Vector2& outside : {Vector2(-0.01, 2), {6.01, 2}, {3, -0.01}, {3, 4.01}})
    EXPECT_FALSE(unproject(small.table, outside)) << outside.transpose();
  for (const auto& [width, height] : {std::pair{1, 4}, {6, 1}, {0, 0}})
    EXPECT_FALSE(unproject(RayTable{width, height, small.rays.data()}, {0.5, 0.5}));
  EXPECT_TRUE(unproject(RayTable{2, 2, small.rays.data()}, {0.5, 0.5}));
}

// A position that needs a missing ray has none; a pixel's own centre needs no neighbour.
TEST(RayTable, NeedsEachOfTheFourRaysThatWeigh) {
  for (const auto& [mx, my] : {std::pair{2, 1}, {3, 1}, {2, 2}, {3, 2}}) {
    SmallTable small;
    small.remove(mx, my);
    EXPECT_FALSE(unproject(small.table, {3, 2}));
    for (const auto& [x, y] : {std::pair{2, 1}, {3, 1}, {2, 2}, {3, 2}}) {
      const bool missing = x == mx && y == my;
      EXPECT_EQ(static_cast<bool>(unproject(small.table, {x + 0.5, y + 0.5})), !missing);
    }
    // On the line between two centres the other two rays have zero weight.
    EXPECT_EQ(static_cast<bool>(unproject(small.table, {3, 1.5})), my == 2);
    EXPECT_EQ(static_cast<bool>(unproject(small.table, {2.5, 2})), mx == 3);
  }
}

TEST(RayTable, CountsALookUpForEachStepOfItsSearch) {
  const SmallTable small;
  const Vector2 middle{3, 2};
  int steps = 5;
  const auto found_from = [&](const Vector2& start, const Vector2& pixel) {
    const int before = steps;
    const Result<Vector2> found = project(
        small.table, 0.3 * small.at(pixel.x() - 0.5, pixel.y() - 0.5), start, middle, steps);
    EXPECT_TRUE(found);
    EXPECT_LT((found.value - pixel).norm(), 1e-5);
    return steps - before;
  };
  EXPECT_LE(found_from({1.5, 1.5}, {1.5, 1.5}), 2) << "a step, and one that confirms it";
  EXPECT_GT(found_from({5.5, 3.5}, {0.7, 0.6}), 2);
  EXPECT_GT(found_from({99, -99}, {0.7, 0.6}), 2) << "from outside";
  EXPECT_GT(found_from({NAN, 1}, {0.7, 0.6}), 1) << "from the middle";
  const int before = steps;
  EXPECT_FALSE(project(small.table, {9, 9, 1}, middle, middle, steps));
  EXPECT_EQ(steps - before, k_lut_search_iterations_max) << "no pixel has this ray";
  EXPECT_FALSE(project(small.table, {0, 0, -1}, middle, middle, steps));
  EXPECT_FALSE(project(small.table, {0.1, 0.1, 1}, middle, {7, 2}, steps)) << "no middle";
  EXPECT_EQ(steps - before, k_lut_search_iterations_max);
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
      // At the rim of the lens circle the search has no derivatives.
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
