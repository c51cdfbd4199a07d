// Occluding-contour test: counts beside a model's outline, on synthetic images.
#include "kernels/registration/outline.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace glint::outline_test {
namespace {

constexpr int k_width = 40, k_height = 30;
constexpr double k_far_m = 0.25;

// The scene is 1 m away; the model is one pixel in the middle of the image.
struct OnePixel {
  int x = 20, y = 15;
  std::vector<float> depth = std::vector<float>(k_width * k_height, 1.0f);
  std::vector<float> model = std::vector<float>(k_width * k_height, 1.0f);
  std::vector<std::int32_t> triangle = std::vector<std::int32_t>(k_width * k_height, -1);

  OnePixel() { triangle[at(x, y)] = 0; }
  static std::size_t at(int x, int y) { return static_cast<std::size_t>(y * k_width + x); }
  [[nodiscard]] SceneView view() const {
    return {{k_width, k_height, 50, 50, 20, 15}, depth, {}, {}, {}};
  }
  [[nodiscard]] OutlineCounts look() const {
    return count_outline(view(), model, triangle, k_far_m);
  }
};

TEST(Outline, LooksToEachOfFourSides) {
  const int sides[4][2] = {{1, 0}, {-1, 0}, {0, 1}, {0, -1}};
  EXPECT_EQ(OnePixel().look().continues, 4);
  EXPECT_EQ(OnePixel().look().falls, 0);
  for (const auto& [right, down] : sides) {
    OnePixel scene;
    for (int d = 1; d < 15; ++d) {
      scene.depth[OnePixel::at(scene.x + d * right, scene.y + d * down)] = 2;
    }
    EXPECT_EQ(scene.look().continues, 3) << right << down;
    EXPECT_EQ(scene.look().falls, 1) << right << down;
  }
}

// The nearest measured pixel from k_outline_from to k_outline_reach counts.
TEST(Outline, LooksAtTheNearestMeasuredPixelWithinItsReach) {
  for (int measured = 1; measured <= k_outline_reach + 2; ++measured) {
    OnePixel scene;
    for (int d = 1; d < 15; ++d) scene.depth[OnePixel::at(scene.x + d, scene.y)] = 0;
    scene.depth[OnePixel::at(scene.x + measured, scene.y)] = 2;
    const bool counts = measured >= k_outline_from && measured <= k_outline_reach;
    EXPECT_EQ(scene.look().falls, counts ? 1 : 0) << measured;
    EXPECT_EQ(scene.look().continues, 3);
    // Pixels behind the nearest one that counts are not read.
    scene.depth[OnePixel::at(scene.x + measured + 1, scene.y)] = 1;
    const bool next = !counts && measured + 1 >= k_outline_from && measured + 1 <= k_outline_reach;
    EXPECT_EQ(scene.look().continues, next ? 4 : 3) << measured;
  }
}

TEST(Outline, FallsBeyondTheLimitAndGoesOnUpToIt) {
  const struct {
    float beside;
    int falls, continues;
  } cases[] = {{1.25f, 0, 4}, {std::nextafter(1.25f, 2.0f), 4, 0},
               {0.75f, 0, 4}, {std::nextafter(0.75f, 0.0f), 0, 0},
               {3, 4, 0},     {0.1f, 0, 0}};
  for (const auto& [beside, falls, continues] : cases) {
    OnePixel scene;
    scene.depth.assign(scene.depth.size(), beside);
    scene.depth[OnePixel::at(scene.x, scene.y)] = 1;
    EXPECT_EQ(scene.look().falls, falls) << beside;
    EXPECT_EQ(scene.look().continues, continues) << beside;
  }
}

// An edge counts only if the scene explains it: the depths differ by at most far_m.
TEST(Outline, CountsEdgesThatTheSceneExplains) {
  for (const auto& [model, counts] :
       {std::pair{1.25f, true}, std::pair{std::nextafter(1.25f, 2.0f), false},
        std::pair{0.75f, true}, std::pair{std::nextafter(0.75f, 0.0f), false}}) {
    OnePixel scene;
    scene.model.assign(scene.model.size(), model);
    EXPECT_EQ(scene.look().continues, counts ? 4 : 0) << model;
  }
  OnePixel unmeasured;
  unmeasured.depth[OnePixel::at(20, 15)] = 0;
  EXPECT_EQ(unmeasured.look().continues, 0);
}

// A side with a model pixel next to it is not an edge; another model pixel ends the search.
TEST(Outline, EndsAtTheModelAndAtThePicture) {
  OnePixel two;
  two.triangle[OnePixel::at(21, 15)] = 5;
  EXPECT_EQ(two.look().continues, 3 + 3);
  for (int between = 2; between <= k_outline_reach + 1; ++between) {
    OnePixel apart;
    apart.triangle[OnePixel::at(20 + between, 15)] = 5;
    const bool ends = between == k_outline_from;  // the search begins there
    EXPECT_EQ(apart.look().continues, 8 - (ends ? 2 : 0)) << between;
  }
  for (const int edge : {0, 1, 2, 3}) {
    OnePixel corner;
    corner.triangle[OnePixel::at(20, 15)] = -1;
    corner.triangle[OnePixel::at(edge, edge)] = 0;
    EXPECT_EQ(corner.look().continues, edge < k_outline_from ? 2 : 4) << edge;
    corner.triangle[OnePixel::at(edge, edge)] = -1;
    corner.triangle[OnePixel::at(k_width - 1 - edge, k_height - 1 - edge)] = 0;
    EXPECT_EQ(corner.look().continues, edge < k_outline_from ? 2 : 4) << edge;
  }
}

TEST(Outline, AddsUpOverPartsOfThePicture) {
  OnePixel scene;
  for (int i = 0; i < k_width * k_height; ++i) {
    if (i * 7 % 11 < 5) scene.triangle[static_cast<std::size_t>(i)] = i;
    scene.depth[static_cast<std::size_t>(i)] = i % 13 < 4 ? 2.0f : 1.0f;
    scene.model[static_cast<std::size_t>(i)] = scene.depth[static_cast<std::size_t>(i)];
  }
  const OutlineCounts whole = scene.look();
  EXPECT_GT(whole.falls, 5);
  EXPECT_GT(whole.continues, 5);
  OutlineCounts sum;
  for (int from = 0; from < k_width * k_height; from += 77) {
    add_outline(scene.view(), scene.model, scene.triangle, k_far_m, from,
                std::min(from + 77, k_width * k_height), sum);
  }
  EXPECT_EQ(sum.falls, whole.falls);
  EXPECT_EQ(sum.continues, whole.continues);
}

}  // namespace
}  // namespace glint::outline_test
