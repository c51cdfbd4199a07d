#include "kernels/registration/align_model.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "kernels/registration/judge_alignment.hpp"
#include "tests/unit/heap_count.hpp"
#include "tests/unit/kernels/registration/box_model.hpp"

namespace glint::align_model_test {
namespace {

using test::BoxArm;
using test::k_truth;

struct Scene {
  BoxArm model;
  Pinhole camera{160, 120, 150, 150, 80, 60};
  std::vector<float> depth = std::vector<float>(160 * 120);
  std::vector<std::uint8_t> mask;
  AlignmentScratch scratch;

  // With a wall 0.4 m behind the arm.
  explicit Scene(double noise_m = 0, const Pose& truth = k_truth) {
    EXPECT_EQ(scratch.prepare(2, 160 * 120, 64), Reason::none);
    std::vector<std::int32_t> face(depth.size());
    std::vector<ProjectedCorner> corners(64);
    EXPECT_EQ(render_depth({model.corners, model.faces}, truth, camera, {depth, face, corners}),
              Reason::none);
    std::mt19937 random(11);
    std::normal_distribution<double> noise(0, noise_m > 0 ? noise_m : 1);
    for (float& z : depth) {
      if (z == 0)
        z = 1.9f;
      else if (noise_m > 0)
        z += static_cast<float>(noise(random));
    }
  }
  [[nodiscard]] SceneView view() const {
    return {camera, depth, mask, {model.corners, model.faces}, {}};
  }
  ModelAlignment align(const Pose& start, const AlignmentSettings& settings = {}) {
    const SceneView one[] = {view()};
    return align_model(one, start, settings, scratch);
  }
  AlignmentScore judge(const Pose& T) {
    const SceneView one[] = {view()};
    return score_alignment(one, T, {}, scratch);
  }
};

Pose start_off(double shift_m, double degrees) {
  const Vector3 way = Vector3(0.5, -0.7, 0.4).normalized();
  return {(Quaternion(Eigen::AngleAxisd(degrees / 57.29578, way)) * k_truth.rotation).normalized(),
          k_truth.translation + shift_m * way.cross(Vector3(0, 0, 1)).normalized()};
}

double degrees_between(const Pose& a, const Pose& b) {
  return a.rotation.angularDistance(b.rotation) * 57.29578;
}

AlignmentSettings single_gate(Matching matching) {
  AlignmentSettings settings;
  for (Gate& gate : settings.gates) {
    gate.matching = matching;
    gate.steps_max = k_alignment_steps_max;
  }
  return settings;
}

TEST(AlignModel, ReturnsToTheTruthFromTenCentimetresAndDegrees) {
  Scene scene;
  const ModelAlignment end = scene.align(start_off(0.1, 10));
  ASSERT_EQ(end.reason, Reason::none);
  EXPECT_LT((end.T_world_base.translation - k_truth.translation).norm(), 2e-4);
  EXPECT_LT(degrees_between(end.T_world_base, k_truth), 0.02);
}

TEST(AlignModel, ReachesTheSameEndByEachWayOfMatching) {
  Scene scene;
  for (const Matching matching : {Matching::point, Matching::plane, Matching::projective}) {
    const ModelAlignment end = scene.align(start_off(0.01, 1), single_gate(matching));
    ASSERT_EQ(end.reason, Reason::none);
    // Points are 9 mm apart in this scene: nearest-point pairs on a shifted raster converge slowly.
    const double least = matching == Matching::projective ? 3e-4 : 4e-3;
    EXPECT_LT((end.T_world_base.translation - k_truth.translation).norm(), least)
        << static_cast<int>(matching);
  }
}

TEST(AlignModel, IsOffByAboutWhatItsCovarianceSays) {
  double shift = 0, turn = 0;
  constexpr int runs = 12;
  for (int i = 0; i < runs; ++i) {
    const Pose truth{k_truth.rotation, k_truth.translation + Vector3(0.003 * i, 0.002 * i, 0)};
    Scene scene(0.008, truth);
    const ModelAlignment end = scene.align(truth);
    const Vector3 off = end.T_world_base.translation - truth.translation;
    shift += off.dot(Matrix3(end.covariance.topLeftCorner<3, 3>()).inverse() * off) / 3 / runs;
    const Quaternion q = end.T_world_base.rotation * truth.rotation.conjugate();
    const Vector3 angle = 2 * q.vec() * (q.w() < 0 ? -1 : 1);
    turn +=
        angle.dot(Matrix3(end.covariance.bottomRightCorner<3, 3>()).inverse() * angle) / 3 / runs;
  }
  EXPECT_GT(shift, 0.3);
  EXPECT_LT(shift, 2.5);
  EXPECT_GT(turn, 0.3);
  EXPECT_LT(turn, 2.5);
}

TEST(AlignModel, IsNotDrawnToWhatStandsInFront) {
  Scene scene;
  for (int y = 0; y < 120; ++y) {
    for (int x = 0; x < 80; ++x) scene.depth[static_cast<std::size_t>(y * 160 + x)] = 0.8f;
  }
  const ModelAlignment end = scene.align(start_off(0.02, 2));
  EXPECT_LT((end.T_world_base.translation - k_truth.translation).norm(), 1e-3);
  EXPECT_LT(scene.judge(end.T_world_base).visible_share(), 0.9);
}

TEST(AlignModel, LeavesWhatIsHiddenOutOfTheWidestGate) {
  // A surface in front hides the left part. Points behind it would match wrong neighbours in the
  // visible part.
  Scene scene;
  for (int y = 0; y < 120; ++y) {
    for (int x = 0; x < 68; ++x) scene.depth[static_cast<std::size_t>(y * 160 + x)] = 0.8f;
  }
  AlignmentSettings wide;
  wide.gate_count = 1;
  wide.gates[0].steps_max = k_alignment_steps_max;
  const ModelAlignment end = scene.align(k_truth, wide);
  EXPECT_LT((end.T_world_base.translation - k_truth.translation).norm(), 0.01);
  EXPECT_LT(degrees_between(end.T_world_base, k_truth),
            3);  // three times as far if hidden points are included
}

TEST(AlignModel, TwoViewsKnowMoreThanOne) {
  Scene scene;
  SceneView views[] = {scene.view(), scene.view()};
  const ModelAlignment both = align_model(views, start_off(0.02, 2), {}, scene.scratch);
  const ModelAlignment one = scene.align(start_off(0.02, 2));
  EXPECT_EQ(both.pairs, 2 * one.pairs);
  // The same scene in the frame of another camera pose.
  const Pose other{Quaternion(Eigen::AngleAxisd(0.7, Vector3::UnitY())), {0.3, -0.1, 0.2}};
  views[0].T_camera_world = other.inverse();
  const ModelAlignment moved =
      align_model({views, 1}, other * start_off(0.02, 2), {}, scene.scratch);
  EXPECT_LT(
      ((other.inverse() * moved.T_world_base).translation - one.T_world_base.translation).norm(),
      1e-5);
}

TEST(AlignModel, SaysWhereNothingCanBeSeen) {
  Scene scene;
  EXPECT_EQ(scene.align({Quaternion::Identity(), {0, 0, -3}}).reason, Reason::degenerate);
  std::fill(scene.depth.begin(), scene.depth.end(), 0.0f);
  EXPECT_EQ(scene.align(k_truth).reason, Reason::degenerate);
  std::fill(scene.depth.begin(), scene.depth.end(), std::nanf(""));
  EXPECT_EQ(scene.align(k_truth).reason, Reason::degenerate);
  scene.depth.pop_back();
  EXPECT_EQ(scene.align(k_truth).reason, Reason::not_prepared);
}

TEST(AlignModel, TakesNoHeapAndGivesTheSameBitsAgain) {
  Scene scene(0.005);
  const ModelAlignment first = scene.align(start_off(0.05, 5));
  const HeapCount heap;
  const ModelAlignment again = scene.align(start_off(0.05, 5));
  EXPECT_EQ(heap.count(), 0u);
  EXPECT_EQ(first.T_world_base.translation, again.T_world_base.translation);
  EXPECT_EQ(first.T_world_base.rotation.coeffs(), again.T_world_base.rotation.coeffs());
  EXPECT_EQ(first.covariance, again.covariance);
}

TEST(JudgeAlignment, TellsAnOutlineFromAPatchOfAWall) {
  Scene scene;
  const AlignmentScore there = scene.judge(k_truth);
  EXPECT_GT(there.outline.falls, 200);
  EXPECT_EQ(there.outline.continues, 0);
  EXPECT_EQ(there.outline_share(), 1);
  // A wall that contains a box's face explains that face, but continues beside it.
  const Pose upright{Quaternion::Identity(), {0, 0, 1}};
  std::fill(scene.depth.begin(), scene.depth.end(), 1.0f);
  const AlignmentScore flat = scene.judge(upright);
  EXPECT_GT(flat.inlier_share(), 0.99);
  EXPECT_EQ(flat.outline.falls, 0);
  EXPECT_GT(flat.outline.continues, 100);  // a face of 30 pixels a side
  EXPECT_LT(flat.outline_share(), 0.2);
  // A pixel in front of the edge, or without depth, counts as neither.
  for (const float beside : {0.0f, 0.5f}) {
    std::vector<float>& depth = scene.depth;
    const AlignmentScratch::View& seen = scene.scratch.views[0];
    for (std::size_t i = 0; i < depth.size(); ++i) depth[i] = seen.triangle[i] >= 0 ? 1.0f : beside;
    const AlignmentScore open = scene.judge(upright);
    EXPECT_EQ(open.outline.falls + open.outline.continues, 0);
    EXPECT_EQ(open.outline_share(), 1);
  }
}

TEST(JudgeAlignment, TellsRightFromSeenThroughAndHidden) {
  Scene scene;
  const AlignmentScore right = scene.judge(k_truth);
  EXPECT_GT(right.inlier_share(), 0.999);
  EXPECT_EQ(right.free_space_violations, 0);
  EXPECT_LT(right.median_m, 1e-3);
  Pose aside = k_truth;
  aside.translation.x() += 0.1;
  EXPECT_GT(scene.judge(aside).seen_through_share(), 0.1);
  Pose behind = k_truth;
  behind.translation.z() += 0.2;
  EXPECT_GT(scene.judge(behind).occluded, 0);
  scene.mask.assign(scene.depth.size(), 0);
  for (std::size_t i = 0; i < scene.depth.size(); ++i) scene.mask[i] = scene.depth[i] < 1.8f;
  EXPECT_GT(scene.judge(k_truth).mask_share(), 0.98);
  EXPECT_LT(scene.judge(aside).mask_share(), 0.8);
}

TEST(JudgeAlignment, GivesTheMedianOfAFewDistances) {
  Scene scene;
  const std::vector<float> whole = scene.depth;
  std::fill(scene.depth.begin(), scene.depth.end(), 0.0f);
  const double shifts_m[] = {0.004, 0.012, 0.020};
  int places = 0;
  for (std::size_t i = 0; i < whole.size() && places < 3; i += 997) {
    if (whole[i] < 1.8f) scene.depth[i] = whole[i] + static_cast<float>(shifts_m[places++]);
  }
  ASSERT_EQ(places, 3);
  const AlignmentScore judged = scene.judge(k_truth);
  ASSERT_EQ(judged.measured, 3);
  EXPECT_NEAR(judged.median_m, shifts_m[1], 0.15 * shifts_m[1]) << "along the ray, so some longer";
}

}  // namespace
}  // namespace glint::align_model_test
