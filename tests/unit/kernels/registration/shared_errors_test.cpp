#include "kernels/registration/shared_errors.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

#include "kernels/registration/align_model.hpp"
#include "kernels/registration/match_points.hpp"
#include "platform/dense.hpp"
#include "tests/unit/heap_count.hpp"
#include "tests/unit/kernels/registration/box_model.hpp"

namespace glint::shared_errors_test {
namespace {

using test::k_truth;

constexpr int k_width = 320, k_height = 240;
const double k_gate_m = AlignmentSettings{}.gates[4].gate_m;

// The arm of boxes without background; the depth has a constant error and slopes in x and y.
struct BiasedScene {
  test::BoxArm model;
  Pinhole camera{k_width, k_height, 300, 300, 160, 120};
  std::vector<float> depth = std::vector<float>(k_width * k_height);
  AlignmentScratch scratch;

  explicit BiasedScene(const Vector3& errors_m) {
    EXPECT_EQ(scratch.prepare(1, k_width * k_height, 64), Reason::none);
    std::vector<std::int32_t> face(depth.size());
    std::vector<ProjectedCorner> corners(64);
    EXPECT_EQ(render_depth({model.corners, model.faces}, k_truth, camera, {depth, face, corners}),
              Reason::none);
    for (int i = 0; i < k_width * k_height; ++i) {
      const double right = (i % k_width + 0.5) / (0.5 * k_width) - 1;
      const double down = (i / k_width + 0.5) / (0.5 * k_height) - 1;
      float& z = depth[static_cast<std::size_t>(i)];
      if (z > 0) z += static_cast<float>(errors_m.dot(Vector3(1, right, down)));
    }
  }
  [[nodiscard]] SceneView view() const {
    return {camera, depth, {}, {model.corners, model.faces}, {}};
  }
};

// Squared Mahalanobis distance of the converged pose, by the consider covariance: at most 1 for a
// single error of one sigma.
double squared_distance(const Vector3& errors_m, double sigma_m) {
  BiasedScene scene(errors_m);
  const SceneView one[] = {scene.view()};
  const ModelAlignment end = align_model(one, k_truth, {}, scene.scratch);
  EXPECT_EQ(end.reason, Reason::none);
  const Result<Matrix6> shared =
      consider_covariance(one, end.T_world_base, k_gate_m, {sigma_m, 1e-5}, scene.scratch);
  EXPECT_EQ(shared.reason, Reason::none);
  const Quaternion turn = end.T_world_base.rotation * k_truth.rotation.conjugate();
  Vector6 off;
  off << end.T_world_base.translation - k_truth.translation,
      2 * turn.vec() * (turn.w() < 0 ? -1 : 1);
  // Allowance for rounding and second-order terms in directions that only the small ray errors
  // cover.
  const Matrix6 rounding = 1e-7 * Matrix6::Identity();
  const Matrix6 inverse = inverse_of(shared.value + rounding);
  return off.dot(inverse * off);
}

TEST(SharedErrors, CoverADepthErrorOfOneSigma) {
  for (const Vector3& unit : {Vector3(1, 0, 0), Vector3(0, 1, 0), Vector3(0, 0, 1)}) {
    const double distance = squared_distance(0.006 * unit, 0.006);
    EXPECT_GT(distance, 0.6) << unit.transpose();
    EXPECT_LT(distance, 1.4) << unit.transpose();
  }
}

TEST(SharedErrors, MovesTheRobotAlongTheRaysByAConstant) {
  BiasedScene scene(Vector3::Zero());
  const SceneView one[] = {scene.view()};
  const Result<Matrix6> shared =
      consider_covariance(one, k_truth, k_gate_m, {0.006, 0}, scene.scratch);
  ASSERT_TRUE(shared);
  EXPECT_GT(std::sqrt(shared.value(2, 2)), 0.004);
  EXPECT_LT(std::sqrt(shared.value(2, 2)), 0.02);
}

TEST(SharedErrors, TurnsTheRobotAboutTheCameraWithItsRays) {
  BiasedScene scene(Vector3::Zero());
  const SceneView one[] = {scene.view()};
  const Result<Matrix6> shared =
      consider_covariance(one, k_truth, k_gate_m, {0, 0.003}, scene.scratch);
  ASSERT_TRUE(shared);
  const Vector3& t = k_truth.translation;
  for (int axis = 0; axis < 3; ++axis) {
    const double lever = Vector3::Unit(axis).cross(t).norm();
    EXPECT_NEAR(shared.value(3 + axis, 3 + axis), 9e-6, 1e-12);
    EXPECT_LT(lever, t.norm() + 1e-9);
  }
  EXPECT_NEAR((shared.value.topLeftCorner<3, 3>().trace()), 2 * 9e-6 * t.squaredNorm(), 1e-9);
}

TEST(SharedErrors, TakesNothingFromTheHeap) {
  BiasedScene scene(Vector3::Zero());
  const SceneView one[] = {scene.view()};
  const HeapCount heap;
  (void)consider_covariance(one, k_truth, k_gate_m, {}, scene.scratch);
  EXPECT_EQ(heap.count(), 0u);
}

TEST(SharedErrors, StatesWhereNothingIsSeen) {
  BiasedScene scene(Vector3::Zero());
  const SceneView one[] = {scene.view()};
  const Pose far{Quaternion::Identity(), {0, 0, -3}};
  EXPECT_EQ(consider_covariance(one, far, k_gate_m, {}, scene.scratch).reason, Reason::degenerate);
  AlignmentScratch small;
  ASSERT_EQ(small.prepare(1, 100, 64), Reason::none);
  EXPECT_EQ(consider_covariance(one, k_truth, k_gate_m, {}, small).reason, Reason::not_prepared);
}

// Reference for the header's equation from single pairs, for two cameras that share their errors.
TEST(SharedErrors, AreThoseOfTheSumsOfAllPairs) {
  BiasedScene scene(Vector3(0.003, -0.002, 0.004));
  ASSERT_EQ(scene.scratch.prepare(2, k_width * k_height, 64), Reason::none);
  SceneView views[] = {scene.view(), scene.view()};
  const Pose other{Quaternion(Eigen::AngleAxisd(0.7, Vector3(1, 2, -1).normalized())),
                   {0.3, -0.1, 0.2}};
  std::vector<std::uint8_t> mask(k_width * k_height, 1);
  for (std::size_t i = 0; i < mask.size(); ++i) mask[i] = i % 5 == 0 ? 0 : 1;
  views[1].mask = mask;
  // Each camera sees the base at the same relative pose.
  const Pose T_world_base = other * k_truth;
  views[0].T_camera_world = views[1].T_camera_world = other.inverse();
  const SystematicErrors errors{0.005, 0.002};
  const Result<Matrix6> found =
      consider_covariance(views, T_world_base, k_gate_m, errors, scene.scratch);
  ASSERT_EQ(found.reason, Reason::none);
  Matrix6 matrix = Matrix6::Zero();
  std::array<Vector6, 3> sums{Vector6::Zero(), Vector6::Zero(), Vector6::Zero()};
  for (std::size_t v = 0; v < 2; ++v) {
    const AlignmentScratch::View& memory = scene.scratch.views[v];
    for (int i = 0; i < memory.visible_count; ++i) {
      const VisiblePoint& seen = memory.seen[static_cast<std::size_t>(i)];
      AlignmentSums pair;
      add_pairs({&seen, 1}, Pose{}, Matching::projective, k_gate_m, views[v], {}, other.rotation,
                views[v].T_camera_world * T_world_base.translation, pair);
      if (pair.count == 0) continue;
      matrix += pair.matrix;
      // 1 m of depth moves the scene's point along the ray by range / z.
      const Vector3 p = seen.point.cast<double>(), n = seen.normal.cast<double>();
      const double along = p.norm() / p.z(), cosine = -n.dot(p) / p.norm();
      const Vector3 lever = other.rotation * (p - k_truth.translation);
      const Vector3 gradient = other.rotation * n * (-1 / cosine);
      Vector6 derivative;
      derivative << gradient, lever.cross(gradient);
      const double right = (seen.pixel % k_width + 0.5) / (0.5 * k_width) - 1;
      const double down = (seen.pixel / k_width + 0.5) / (0.5 * k_height) - 1;
      sums[0] += derivative * along;
      sums[1] += derivative * along * right;
      sums[2] += derivative * along * down;
    }
  }
  const Matrix6 inverse = inverse_of(matrix.selfadjointView<Eigen::Lower>());
  Matrix6 expected = Matrix6::Zero();
  for (const Vector6& sum : sums) {
    const Vector6 moves = errors.depth_sigma_m * inverse * sum;
    expected += moves * moves.transpose();
  }
  // A rotation of the rays about the camera moves the base with them.
  const Vector3 lever = T_world_base.translation - other.translation;
  for (int axis = 0; axis < 3; ++axis) {
    Vector6 moves;
    moves << Vector3::Unit(axis).cross(lever), Vector3::Unit(axis);
    expected += errors.ray_sigma_rad * errors.ray_sigma_rad * moves * moves.transpose();
  }
  EXPECT_LT((found.value - expected).norm(), 1e-6 * expected.norm());
}

}  // namespace
}  // namespace glint::shared_errors_test
