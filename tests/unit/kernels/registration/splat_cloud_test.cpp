#include "kernels/registration/splat_cloud.hpp"

#include <gtest/gtest.h>

#include "kernels/registration/judge_alignment.hpp"
#include "tests/unit/heap_count.hpp"
#include "tests/unit/kernels/registration/box_model.hpp"

namespace glint::splat_cloud_test {
namespace {

using test::BoxArm;
using test::k_truth;
using test::SampledModel;

constexpr std::size_t k_pixels = 160 * 120;

struct DepthBuffers {
  std::vector<float> z = std::vector<float>(k_pixels);
  std::vector<std::int32_t> number = std::vector<std::int32_t>(k_pixels);
  std::vector<ProjectedCorner> corners = std::vector<ProjectedCorner>(100'000);
  [[nodiscard]] DepthBuffer buffer() { return {z, number, corners}; }
};

struct Scene {
  BoxArm model;
  SampledModel sampled{model, 0.004f};
  Pinhole camera{160, 120, 150, 150, 80, 60};
  DepthBuffers rendered;
  std::vector<float> depth;
  AlignmentScratch scratch;

  explicit Scene(double noise_m = 0) {
    EXPECT_EQ(render_depth({model.corners, model.faces}, k_truth, camera, rendered.buffer()),
              Reason::none);
    std::mt19937 random(11);
    std::normal_distribution<double> noise(0, noise_m > 0 ? noise_m : 1);
    for (const float z : rendered.z) {
      depth.push_back(z == 0 ? 1.9f : noise_m > 0 ? z + static_cast<float>(noise(random)) : z);
    }
    EXPECT_EQ(scratch.prepare(1, k_pixels, 100'000), Reason::none);
  }
  [[nodiscard]] SceneView view() const { return {camera, depth, {}, {}, {}, sampled.cloud()}; }
};

TEST(SplatCloud, SeesWhatItsSurfaceShows) {
  Scene scene;
  DepthBuffers splatted;
  ASSERT_EQ(splat_cloud(scene.sampled.cloud(), k_truth, scene.camera, splatted.buffer()),
            Reason::none);
  int both = 0, only_one = 0, apart = 0;
  for (std::size_t i = 0; i < k_pixels; ++i) {
    const bool a = scene.rendered.number[i] >= 0, b = splatted.number[i] >= 0;
    both += a && b ? 1 : 0;
    only_one += a != b ? 1 : 0;
    apart += a && b && std::abs(scene.rendered.z[i] - splatted.z[i]) > 0.005f ? 1 : 0;
  }
  EXPECT_GT(both, 1500);
  EXPECT_LT(only_one, both / 10);  // the silhouette, by at most one pixel
  EXPECT_LT(apart, both / 20);     // depth edges between parts; no holes
}

TEST(SplatCloud, SeenPointsLieOnTheSurfaceAndFaceTheCamera) {
  Scene scene;
  DepthBuffers splatted;
  std::vector<VisiblePoint> seen(k_pixels);
  const int count = visible_cloud_points(scene.view(), k_truth, 1, splatted.buffer(), seen);
  EXPECT_GT(count, 1500);
  int beside = 0, off = 0;
  for (int i = 0; i < count; ++i) {
    const VisiblePoint& p = seen[static_cast<std::size_t>(i)];
    EXPECT_LT(p.normal.dot(p.point), 0);
    const auto pixel = static_cast<std::size_t>(p.pixel);
    if (scene.rendered.number[pixel] < 0)
      ++beside;
    else
      off += std::abs(scene.rendered.z[pixel] - p.point.z()) > 1e-5f ? 1 : 0;
  }
  EXPECT_LT(beside, count / 50);
  EXPECT_LT(off, count / 50);  // at edges between two sides
  const int fewer = visible_cloud_points(scene.view(), k_truth, 4, splatted.buffer(), seen);
  EXPECT_NEAR(fewer, count / 16, count / 50);
}

TEST(SplatCloud, AlignsAndJudgesAsTrianglesDo) {
  Scene scene(0.008);
  const Vector3 way = Vector3(0.5, -0.7, 0.4).normalized();
  const Pose start{(Quaternion(Eigen::AngleAxisd(0.1, way)) * k_truth.rotation).normalized(),
                   k_truth.translation + 0.06 * way};
  const SceneView cloud[] = {scene.view()};
  SceneView with_triangles = scene.view();
  with_triangles.cloud = {};
  with_triangles.model = {scene.model.corners, scene.model.faces};
  const SceneView triangles[] = {with_triangles};
  const ModelAlignment a = align_model(cloud, start, {}, scene.scratch);
  const ModelAlignment b = align_model(triangles, start, {}, scene.scratch);
  ASSERT_EQ(a.reason, Reason::none);
  // Same scene and noise: only the points that represent the surface differ.
  const double sigma = std::sqrt(b.covariance.topLeftCorner<3, 3>().trace());
  EXPECT_LT((a.T_world_base.translation - b.T_world_base.translation).norm(), sigma);
  EXPECT_LT((a.T_world_base.translation - k_truth.translation).norm(), 3 * sigma);
  EXPECT_LT(std::sqrt(a.covariance.topLeftCorner<3, 3>().trace()), 1.3 * sigma);
  const AlignmentScore judged = score_alignment(cloud, a.T_world_base, {}, scene.scratch);
  EXPECT_GT(judged.inlier_share(), 0.99);
  EXPECT_LT(judged.seen_through_share(), 0.03);  // discs that extend beyond edges
  EXPECT_GT(judged.outline_share(), 0.95);
  Pose aside = k_truth;
  aside.translation.x() += 0.1;
  EXPECT_GT(score_alignment(cloud, aside, {}, scene.scratch).seen_through_share(), 0.1);
}

TEST(SplatCloud, RefusesSizesThatDoNotFit) {
  Scene scene;
  DepthBuffers picture;
  ModelCloud cloud = scene.sampled.cloud();
  DepthBuffer small = picture.buffer();
  small.corners = small.corners.first(10);
  EXPECT_EQ(splat_cloud(cloud, k_truth, scene.camera, small), Reason::out_of_range);
  cloud.normals = cloud.normals.first(10);
  EXPECT_EQ(splat_cloud(cloud, k_truth, scene.camera, picture.buffer()), Reason::out_of_range);
  SceneView wrong[] = {scene.view()};
  wrong[0].cloud.normals = cloud.normals;
  EXPECT_EQ(align_model(wrong, k_truth, {}, scene.scratch).reason, Reason::not_prepared);
  AlignmentScratch few;
  ASSERT_EQ(few.prepare(1, k_pixels, 10), Reason::none);
  const SceneView large[] = {scene.view()};
  EXPECT_EQ(align_model(large, k_truth, {}, few).reason, Reason::not_prepared);
}

TEST(SplatCloud, EndsAfterItsBudgetOfTests) {
  DepthBuffers picture;
  const Pinhole camera{160, 120, 1500, 1500, 80, 60};
  const std::vector<Vector3f> points(60'000, Vector3f(0, 0, 0.1f)),
      normals(60'000, Vector3f(0, 0, 1));
  EXPECT_EQ(splat_cloud({points, normals, 0.01f}, {}, camera, picture.buffer()),
            Reason::search_full);
  EXPECT_GT(picture.z[60 * 160 + 80], 0);
}

TEST(SplatCloud, LeavesOutWhatIsNoPlace) {
  DepthBuffers picture;
  const float nan = std::nanf("");
  const std::vector<Vector3f> points = {{nan, 0, 1}, {0, 0, nan}, {0, 0, -1}, {1e30f, 0, 1e-3f}};
  const std::vector<Vector3f> normals(4, Vector3f(0, 0, 1));
  const Pinhole camera{160, 120, 150, 150, 80, 60};
  ASSERT_EQ(splat_cloud({points, normals, 0.01f}, {}, camera, picture.buffer()), Reason::none);
  for (const std::int32_t number : picture.number) ASSERT_EQ(number, -1);
}

TEST(SplatCloud, TakesNoHeapAndGivesTheSameBitsAgain) {
  Scene scene(0.005);
  const SceneView views[] = {scene.view()};
  const ModelAlignment first = align_model(views, k_truth, {}, scene.scratch);
  const HeapCount heap;
  const ModelAlignment again = align_model(views, k_truth, {}, scene.scratch);
  EXPECT_EQ(heap.count(), 0u);
  EXPECT_EQ(first.T_world_base.translation, again.T_world_base.translation);
  EXPECT_EQ(first.T_world_base.rotation.coeffs(), again.T_world_base.rotation.coeffs());
}

}  // namespace
}  // namespace glint::splat_cloud_test
