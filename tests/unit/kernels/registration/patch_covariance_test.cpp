#include "kernels/registration/patch_covariance.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <random>
#include <set>
#include <span>
#include <vector>

#include "kernels/registration/align_model.hpp"
#include "kernels/registration/match_points.hpp"
#include "platform/dense.hpp"
#include "tests/unit/heap_count.hpp"
#include "tests/unit/kernels/registration/box_model.hpp"
#include "tests/unit/repetitions.hpp"

namespace glint::patch_covariance_test {
namespace {

using test::k_truth;

constexpr int k_width = 320, k_height = 240;
constexpr double k_noise_m = 0.008;
const double k_gate_m = AlignmentSettings{}.gates[4].gate_m;

// The arm of boxes without background; blocks of `block` x `block` pixels share a depth error.
struct NoisyScene {
  test::BoxArm model;
  Pinhole camera{k_width, k_height, 300, 300, 160, 120};
  std::vector<float> depth = std::vector<float>(k_width * k_height);
  AlignmentScratch scratch;

  NoisyScene(int block, unsigned seed) {
    EXPECT_EQ(scratch.prepare(1, k_width * k_height, 64), Reason::none);
    std::vector<std::int32_t> face(depth.size());
    std::vector<ProjectedCorner> corners(64);
    EXPECT_EQ(render_depth({model.corners, model.faces}, k_truth, camera, {depth, face, corners}),
              Reason::none);
    std::mt19937 random(seed);
    std::normal_distribution<double> noise(0, k_noise_m);
    std::vector<float> shared(depth.size());
    for (float& off : shared) off = static_cast<float>(noise(random));
    for (int y = 0; y < k_height; ++y) {
      for (int x = 0; x < k_width; ++x) {
        float& z = depth[static_cast<std::size_t>(y * k_width + x)];
        if (z > 0) z += shared[static_cast<std::size_t>(y / block * k_width + x / block)];
      }
    }
  }
  [[nodiscard]] SceneView view() const {
    return {camera, depth, {}, {model.corners, model.faces}, {}};
  }
};

// Mean squared Mahalanobis distance per degree of freedom (of six), by each covariance.
struct Consistency {
  double independent = 0, patches = 0;
};
Consistency consistency(int block) {
  const int scenes = test::repetitions(60, 15);
  Consistency mean;
  for (int seed = 1; seed <= scenes; ++seed) {
    NoisyScene scene(block, static_cast<unsigned>(seed));
    const SceneView one[] = {scene.view()};
    const ModelAlignment end = align_model(one, k_truth, {}, scene.scratch);
    EXPECT_EQ(end.reason, Reason::none);
    const Result<Matrix6> clustered =
        patch_covariance(one, end.T_world_base, k_gate_m, scene.scratch);
    EXPECT_EQ(clustered.reason, Reason::none);
    const Quaternion turn = end.T_world_base.rotation * k_truth.rotation.conjugate();
    Vector6 off;
    off << end.T_world_base.translation - k_truth.translation,
        2 * turn.vec() * (turn.w() < 0 ? -1 : 1);
    const Matrix6 of_independent = inverse_of(end.covariance);
    const Matrix6 of_patches = inverse_of(clustered.value);
    mean.independent += off.dot(of_independent * off) / 6 / scenes;
    mean.patches += off.dot(of_patches * off) / 6 / scenes;
  }
  return mean;
}

TEST(PatchCovariance, SaysTheSameOfIndependentNoise) {
  const Consistency mean = consistency(1);
  EXPECT_GT(mean.independent, 0.6);
  EXPECT_LT(mean.independent, 1.5);
  EXPECT_GT(mean.patches / mean.independent, 0.7);
  EXPECT_LT(mean.patches / mean.independent, 1.5);
}

TEST(PatchCovariance, KnowsHowSureItIsWhereNeighboursErrAlike) {
  const Consistency mean = consistency(8);
  EXPECT_GT(mean.independent, 15);
  EXPECT_LT(mean.patches, 2);
}

// Reference for the header's equation, patch by patch from single pairs; each view has its own
// patches.
Matrix6 plain_patch_covariance(std::span<const SceneView> views, const Pose& T_world_base,
                               const AlignmentScratch& scratch) {
  Matrix6 matrix = Matrix6::Zero(), spread = Matrix6::Zero();
  double count = 0;
  for (std::size_t v = 0; v < views.size(); ++v) {
    const Vector3 origin = views[v].T_camera_world * T_world_base.translation;
    std::map<std::pair<int, int>, Vector6> patches;
    const AlignmentScratch::View& view = scratch.views[v];
    for (int i = 0; i < view.visible_count; ++i) {
      const VisiblePoint& point = view.seen[static_cast<std::size_t>(i)];
      AlignmentSums pair;
      add_pairs({&point, 1}, Pose{}, Matching::projective, k_gate_m, views[v], {},
                views[v].T_camera_world.inverse().rotation, origin, pair);
      if (pair.count == 0) continue;
      matrix += pair.matrix;
      const auto patch =
          std::pair(point.pixel % k_width / k_patch_pixels, point.pixel / k_width / k_patch_pixels);
      const auto [at, added] = patches.try_emplace(patch, Vector6::Zero());
      at->second += pair.slope;
    }
    for (const auto& [patch, sum] : patches) spread += sum * sum.transpose();
    count += static_cast<double>(patches.size());
  }
  const Matrix6 whole = matrix.selfadjointView<Eigen::Lower>();
  const Matrix6 inverse = inverse_of(whole);
  return count / (count - 6) * inverse * spread * inverse;
}

TEST(PatchCovariance, IsThatOfTheSumsOfItsPatches) {
  NoisyScene scene(8, 3);
  ASSERT_EQ(scene.scratch.prepare(2, k_width * k_height, 64), Reason::none);
  const Pose other{Quaternion(Eigen::AngleAxisd(0.7, Vector3(1, 2, -1).normalized())),
                   {0.3, -0.1, 0.2}};
  SceneView views[] = {scene.view(), scene.view()};
  for (SceneView& view : views) view.T_camera_world = other.inverse();
  // The second camera sees the lower half only.
  std::vector<std::uint8_t> mask(k_width * k_height, 0);
  std::fill(mask.begin() + k_width * 125, mask.end(), 1);
  views[1].mask = mask;
  for (const std::size_t count : {1u, 2u}) {
    const std::span<const SceneView> of_count = std::span(views).first(count);
    const Result<Matrix6> found =
        patch_covariance(of_count, other * k_truth, k_gate_m, scene.scratch);
    ASSERT_EQ(found.reason, Reason::none);
    const Matrix6 expected = plain_patch_covariance(of_count, other * k_truth, scene.scratch);
    EXPECT_LT((found.value - expected).norm(), 1e-9 * expected.norm()) << count;
  }
}

TEST(PatchCovariance, NeedsAsManyPatchesAsDeclared) {
  NoisyScene scene(1, 5);
  const SceneView one[] = {scene.view()};
  ASSERT_EQ(patch_covariance(one, k_truth, k_gate_m, scene.scratch).reason, Reason::none);
  const AlignmentScratch::View& memory = scene.scratch.views[0];
  const auto patch_of = [](int pixel) {
    return std::pair(pixel % k_width / k_patch_pixels, pixel / k_width / k_patch_pixels);
  };
  std::set<std::pair<int, int>> with_pairs;
  for (int i = 0; i < memory.visible_count; ++i) {
    const VisiblePoint& point = memory.seen[static_cast<std::size_t>(i)];
    AlignmentSums pair;
    add_pairs({&point, 1}, Pose{}, Matching::projective, k_gate_m, one[0], {},
              Quaternion::Identity(), k_truth.translation, pair);
    if (pair.count > 0) with_pairs.insert(patch_of(point.pixel));
  }
  ASSERT_GT(with_pairs.size(), static_cast<std::size_t>(k_patches_min));
  for (const int count : {k_patches_min - 1, k_patches_min}) {
    const std::set<std::pair<int, int>> shown(with_pairs.begin(),
                                              std::next(with_pairs.begin(), count));
    std::vector<std::uint8_t> mask;
    for (int i = 0; i < k_width * k_height; ++i)
      mask.push_back(shown.contains(patch_of(i)) ? 1 : 0);
    SceneView few[] = {scene.view()};
    few[0].mask = mask;
    EXPECT_EQ(patch_covariance(few, k_truth, k_gate_m, scene.scratch).reason,
              count < k_patches_min ? Reason::degenerate : Reason::none);
  }
}

TEST(PatchCovariance, TakesNothingFromTheHeap) {
  NoisyScene scene(1, 1);
  const SceneView one[] = {scene.view()};
  const HeapCount heap;
  (void)patch_covariance(one, k_truth, k_gate_m, scene.scratch);
  EXPECT_EQ(heap.count(), 0u);
}

TEST(PatchCovariance, SaysWhereItKnowsNothing) {
  NoisyScene scene(1, 1);
  const SceneView one[] = {scene.view()};
  const Pose far{Quaternion::Identity(), {0, 0, -3}};
  EXPECT_EQ(patch_covariance(one, far, k_gate_m, scene.scratch).reason, Reason::degenerate);
  AlignmentScratch small;
  ASSERT_EQ(small.prepare(1, 100, 64), Reason::none);
  EXPECT_EQ(patch_covariance(one, k_truth, k_gate_m, small).reason, Reason::not_prepared);
}

}  // namespace
}  // namespace glint::patch_covariance_test
