// Scratch memory of an alignment: limits of its sizes, and the scene grid built in it.
#include "kernels/registration/alignment_scratch.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <span>
#include <vector>

namespace glint::alignment_scratch_test {
namespace {

TEST(AlignmentScratch, TakesEachSizeAtItsLimitAndRefusesItBeyond) {
  AlignmentScratch scratch;
  EXPECT_EQ(scratch.prepare(1, 1, 1), Reason::none);
  EXPECT_EQ(scratch.prepare(k_scene_views_max, 1, 1), Reason::none);
  EXPECT_EQ(scratch.prepare(1, k_scene_pixels_max, 1), Reason::none);
  EXPECT_EQ(scratch.prepare(0, 1, 1), Reason::out_of_range);
  EXPECT_EQ(scratch.prepare(k_scene_views_max + 1, 1, 1), Reason::out_of_range);
  EXPECT_EQ(scratch.prepare(1, 0, 1), Reason::out_of_range);
  EXPECT_EQ(scratch.prepare(1, k_scene_pixels_max + 1, 1), Reason::out_of_range);
  EXPECT_EQ(scratch.prepare(1, 1, 0), Reason::out_of_range);
  EXPECT_EQ(scratch.prepare(1, 1, k_scene_corners_max + 1), Reason::out_of_range);
}

TEST(AlignmentScratch, HasRoomForEachViewsPixelsCornersAndPatches) {
  AlignmentScratch scratch;
  ASSERT_EQ(scratch.prepare(3, 50, 7), Reason::none);
  ASSERT_EQ(scratch.views.size(), 3u);
  for (AlignmentScratch::View& view : scratch.views) {
    EXPECT_EQ(view.z.size(), 50u);
    EXPECT_EQ(view.triangle.size(), 50u);
    EXPECT_EQ(view.seen.size(), 50u);
    EXPECT_EQ(view.scene.size(), 50u);
    EXPECT_EQ(view.corners.size(), 7u);
    EXPECT_EQ(view.patches.size(), 4u);
    EXPECT_EQ(view.grid.build(std::vector<Vector3f>(50, Vector3f(0, 0, 1)), 0.1), Reason::none);
  }
}

// A view of 5 x 4 pixels with 3 corners or points; the scratch has room for two views.
struct Scene {
  std::vector<float> depth = std::vector<float>(20, 1);
  std::vector<std::uint8_t> mask;
  std::vector<Vector3f> corners = std::vector<Vector3f>(3, Vector3f(0, 0, 1));
  std::vector<Face> faces = {{0, 1, 2}};
  AlignmentScratch scratch;

  Scene() { EXPECT_EQ(scratch.prepare(2, 20, 3), Reason::none); }
  [[nodiscard]] SceneView view() const {
    return {{5, 4, 5, 5, 2.5, 2}, depth, mask, {corners, faces}, {}};
  }
};

TEST(SceneFits, WhereEachSizeIsThatOfTheCameraAndNoMoreThanTheScratchs) {
  const auto fits = [](auto change) {
    Scene scene;
    std::vector<SceneView> views(2);
    const std::vector<std::uint8_t> masks(21, 1);
    const std::vector<Vector3f> points(4, Vector3f(0, 0, 1));
    for (const std::size_t wrong : {0u, 1u}) {
      views.assign(2, scene.view());
      change(views[wrong], std::span(scene.depth), std::span(masks), std::span(points));
      if (scene_fits(views, scene.scratch)) continue;
      views.assign(2, scene.view());
      EXPECT_TRUE(scene_fits(views, scene.scratch));
      return false;
    }
    return true;
  };
  using Depth = std::span<float>;
  using Mask = std::span<const std::uint8_t>;
  using Points = std::span<const Vector3f>;
  EXPECT_TRUE(fits([](SceneView&, Depth, Mask, Points) {}));
  EXPECT_TRUE(fits([](SceneView& v, Depth, Mask m, Points) { v.mask = m.first(20); }));
  EXPECT_FALSE(fits([](SceneView& v, Depth, Mask m, Points) { v.mask = m.first(19); }));
  EXPECT_FALSE(fits([](SceneView& v, Depth, Mask m, Points) { v.mask = m; }));
  EXPECT_FALSE(fits([](SceneView& v, Depth d, Mask, Points) { v.depth_m = d.first(19); }));
  EXPECT_FALSE(fits([](SceneView& v, Depth d, Mask, Points) {
    v.camera.width = -5, v.camera.height = -4, v.depth_m = d;
  }));
  EXPECT_FALSE(fits(
      [](SceneView& v, Depth d, Mask, Points) { v.camera.width = 0, v.depth_m = d.first(0); }));
  EXPECT_FALSE(fits(
      [](SceneView& v, Depth d, Mask, Points) { v.camera.height = 0, v.depth_m = d.first(0); }));
  EXPECT_TRUE(fits([](SceneView& v, Depth d, Mask, Points) {
    v.camera.width = 1, v.camera.height = 1, v.depth_m = d.first(1);
  }));
  EXPECT_FALSE(fits([](SceneView& v, Depth, Mask, Points p) { v.model.corners = p; }));
  EXPECT_TRUE(fits(
      [](SceneView& v, Depth, Mask, Points p) { v.cloud.points = v.cloud.normals = p.first(3); }));
  EXPECT_FALSE(
      fits([](SceneView& v, Depth, Mask, Points p) { v.cloud.points = v.cloud.normals = p; }));
  EXPECT_FALSE(fits([](SceneView& v, Depth, Mask, Points p) { v.cloud.points = p.first(3); }));
  EXPECT_FALSE(fits([](SceneView& v, Depth, Mask, Points p) { v.cloud.normals = p.first(3); }));
  Scene scene;
  const std::vector<SceneView> three(3, scene.view());
  EXPECT_FALSE(scene_fits({}, scene.scratch));
  EXPECT_FALSE(scene_fits(three, scene.scratch));
  AlignmentScratch less;
  ASSERT_EQ(less.prepare(2, 19, 3), Reason::none);
  EXPECT_FALSE(scene_fits(std::span(three).first(2), less));
}

// Measured pixels that the mask allows: every step-th of every step-th row.
TEST(SearchScene, TakesTheMeasuredPixelsOfTheRaster) {
  Scene scene;
  scene.mask.assign(20, 1);
  for (int i = 0; i < 20; ++i)
    scene.depth[static_cast<std::size_t>(i)] = 1 + 0.5f * static_cast<float>(i);
  scene.depth[2] = 0, scene.depth[4] = -1, scene.depth[10] = std::nanf("");
  scene.mask[0] = 0, scene.mask[7] = 0;
  for (const int step : {1, 2, 3}) {
    AlignmentScratch::View& memory = scene.scratch.views[0];
    index_scene(scene.view(), step, 0.2, memory);
    std::size_t count = 0;
    for (int y = 0; y < 4; y += step) {
      for (int x = 0; x < 5; x += step) {
        const int i = y * 5 + x;
        if (i == 0 || i == 2 || i == 4 || i == 7 || i == 10) continue;
        const float z = 1 + 0.5f * static_cast<float>(i);
        const Vector3f expected((static_cast<float>(x) - 2) / 5 * z,
                                (static_cast<float>(y) - 1.5f) / 5 * z, z);
        EXPECT_LT((memory.scene[count] - expected).norm(), 1e-5f);
        EXPECT_EQ(memory.grid.nearest(expected, 0.2f).index, static_cast<int>(count));
        ++count;
      }
    }
    EXPECT_EQ(memory.grid.size(), static_cast<int>(count)) << step;
  }
}

TEST(SceneIndexing, GivesTheSearchOfAllPixelsForTheStepsOfPixelsAndGrid) {
  Scene scene;
  for (int i = 0; i < 20; ++i) {
    scene.depth[static_cast<std::size_t>(i)] = i % 4 == 1 ? 0 : 1 + 0.5f * static_cast<float>(i);
  }
  AlignmentScratch::View &whole = scene.scratch.views[0], &sliced = scene.scratch.views[1];
  index_scene(scene.view(), 1, 0.2, whole);
  StepBudget building;
  PointGrid grid;
  ASSERT_EQ(grid.prepare(20), Reason::none);
  EXPECT_EQ(grid.begin_build(std::span(whole.scene).first(15), 0.2), Reason::none);
  while (!grid.build_step(building)) {
  }
  const int expected = 20 * k_scene_pixel_steps + SliceSize::k_steps_max - building.left();
  SceneIndexing indexing;
  for (const int budget : {1, 40, SliceSize::k_steps_max, 7}) {
    if (budget == 40) {  // interrupted
      indexing.start();
      StepBudget some(100);
      EXPECT_FALSE(indexing.step(scene.view(), 0.2, some, sliced));
    }
    indexing.start();
    int steps = 0;
    for (bool done = false; !done;) {
      StepBudget left(budget);
      done = indexing.step(scene.view(), 0.2, left, sliced);
      steps += budget - left.left();
    }
    EXPECT_EQ(steps, expected) << budget;
    EXPECT_EQ(sliced.grid.size(), 15);
    for (std::size_t i = 0; i < 15; ++i) EXPECT_EQ(sliced.scene[i], whole.scene[i]);
  }
}

}  // namespace
}  // namespace glint::alignment_scratch_test
