// Gauss-Newton steps of an alignment: normal equations, gates, slices, convergence, step counts.
#include "kernels/registration/align_model.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <span>
#include <vector>

#include "platform/dense.hpp"
#include "tests/unit/kernels/registration/box_model.hpp"

namespace glint::align_steps_test {
namespace {

using test::BoxArm;
using test::k_truth;

constexpr int k_pixels = 160 * 120;

// The arm in front of a wall, seen by two cameras.
struct TwoViews {
  BoxArm model;
  Pinhole camera{160, 120, 150, 150, 80, 60};
  std::vector<float> depth[2];
  Pose T_camera_world[2] = {
      {Quaternion(Eigen::AngleAxisd(0.3, Vector3::UnitX())), {0.1, 0.25, 0.1}},
      {Quaternion(Eigen::AngleAxisd(-0.2, Vector3::UnitY())), {0.35, 0.05, -0.05}}};
  AlignmentScratch scratch;

  explicit TwoViews(double noise_m) {
    EXPECT_EQ(scratch.prepare(2, k_pixels, 64), Reason::none);
    std::mt19937 random(11);
    std::normal_distribution<double> noise(0, noise_m);
    for (int v = 0; v < 2; ++v) {
      depth[v].resize(k_pixels);
      std::vector<std::int32_t> face(k_pixels);
      std::vector<ProjectedCorner> corners(64);
      EXPECT_EQ(render_depth({model.corners, model.faces}, T_camera_world[v] * k_truth, camera,
                             {depth[v], face, corners}),
                Reason::none);
      for (float& z : depth[v]) z = z == 0 ? 1.9f : z + static_cast<float>(noise(random));
    }
  }
  [[nodiscard]] std::vector<SceneView> views() const {
    std::vector<SceneView> both;
    for (int v = 0; v < 2; ++v) {
      both.push_back({camera, depth[v], {}, {model.corners, model.faces}, T_camera_world[v]});
    }
    return both;
  }
};

AlignmentSettings settings_with_gates(const std::vector<Gate>& of) {
  AlignmentSettings settings;
  std::copy(of.begin(), of.end(), settings.gates.begin());
  settings.gate_count = static_cast<int>(of.size());
  return settings;
}

constexpr Gate k_projective{0.035, Matching::projective, 1, 1, false};

Pose start_off() {
  const Quaternion turn(Eigen::AngleAxisd(0.01, Vector3(0.5, -0.7, 0.4).normalized()));
  return {(turn * k_truth.rotation).normalized(), k_truth.translation + Vector3(0.004, 0.002, 0)};
}

// Reference: centroid of the visible points, Gauss-Newton step and residual, from all pairs at
// once.
TEST(AlignSteps, AreThoseOfGaussAndNewtonOverTheSeenPointsOfAllViews) {
  TwoViews scene(0.004);
  const std::vector<SceneView> views = scene.views();
  AlignmentRun run;
  run.start(start_off(), settings_with_gates({k_projective}));
  while (run.step(views, scene.scratch)) {
  }
  const ModelAlignment& found = run.result();
  ASSERT_EQ(found.reason, Reason::none);
  Vector3 centroid = Vector3::Zero();
  int seen = 0;
  for (std::size_t v = 0; v < 2; ++v) {
    AlignmentScratch::View& memory = scene.scratch.views[v];
    render_model(views[v], start_off(), 1, memory);
    for (int i = 0; i < memory.visible_count; ++i, ++seen) {
      centroid += views[v].T_camera_world.inverse() *
                  memory.seen[static_cast<std::size_t>(i)].point.cast<double>();
    }
  }
  centroid /= seen;
  EXPECT_LT((run.centroid() - centroid).norm(), 1e-9);
  AlignmentSums sums;
  for (std::size_t v = 0; v < 2; ++v) {
    const AlignmentScratch::View& memory = scene.scratch.views[v];
    add_pairs(std::span(memory.seen).first(static_cast<std::size_t>(memory.visible_count)), Pose{},
              Matching::projective, k_projective.gate_m, views[v], {},
              views[v].T_camera_world.inverse().rotation, views[v].T_camera_world * centroid, sums);
  }
  const Matrix6 matrix = sums.matrix.selfadjointView<Eigen::Lower>();
  const Vector6 step = solve_symmetric(matrix, -sums.slope);
  const Vector3 shift = step.head<3>(), turn = step.tail<3>();
  const Quaternion by(Eigen::AngleAxisd(turn.norm(), turn.normalized()));
  const Vector3 origin = by * (start_off().translation - centroid) + centroid + shift;
  EXPECT_LT((found.T_world_base.translation - origin).norm(), 1e-8);
  EXPECT_LT(found.T_world_base.rotation.angularDistance(by * start_off().rotation), 1e-7);
  EXPECT_GT(shift.norm(), 1e-3);
  EXPECT_EQ(found.steps, 1);
  EXPECT_EQ(found.pairs, sums.count);
  EXPECT_NEAR(found.residual_m, std::sqrt(sums.squares / sums.count), 1e-9);
  // Covariance of the base's origin, which a rotation about the centroid translates.
  Matrix6 to_origin = Matrix6::Identity();
  for (int axis = 0; axis < 3; ++axis) {
    to_origin.block<3, 1>(0, 3 + axis) = Vector3::Unit(axis).cross(origin - centroid);
  }
  const Matrix6 expected =
      to_origin * (matrix.inverse() * sums.squares / (sums.count - 6)) * to_origin.transpose();
  EXPECT_LT((found.covariance - expected).norm(), 1e-6 * expected.norm());
}

// Converged when a step is below both limits; point and plane gates use at least gate_m / 50.
TEST(AlignSteps, EndAtRestOrAsManyAsTheGateHas) {
  TwoViews scene(0.004);
  const auto steps_of = [&](Matching matching, double shift, double turn) {
    Gate gate = k_projective;
    gate.matching = matching;
    gate.gate_m = matching == Matching::projective ? 0.035 : 0.15;
    gate.step = 4;
    gate.steps_max = 7;
    AlignmentSettings settings = settings_with_gates({gate});
    settings.convergence_translation_m = shift;
    settings.convergence_rotation_rad = turn;
    return align_model(scene.views(), k_truth, settings, scene.scratch).steps;
  };
  EXPECT_EQ(steps_of(Matching::projective, 9, 9), 1);
  EXPECT_EQ(steps_of(Matching::projective, 9, 0), 7);
  EXPECT_EQ(steps_of(Matching::projective, 0, 9), 7);
  EXPECT_EQ(steps_of(Matching::plane, 9, 9), 1);
  // From the ground truth, a step is below 3 mm and 3 mrad.
  EXPECT_LE(steps_of(Matching::plane, 0, 0), 2);
  EXPECT_LE(steps_of(Matching::plane, 9, 0), 2);
}

TEST(AlignSteps, TakeAsManySlicesAsTheirGatesSay) {
  TwoViews scene(0.004);
  const struct {
    std::vector<Gate> gates;
    int one_view, two_views;
  } cases[] = {{{{0.035, Matching::projective, 4, 4, false}}, 4 + 1, 4 + 2},
               {{{0.035, Matching::projective, 4, 4, true}}, 4 + 4, 4 + 8},
               {{{0.15, Matching::plane, 4, 3, false}}, 1 + 3 + 1, 2 + 3 + 2},
               {{{0.15, Matching::point, 4, 3, true}}, 1 + 3 + 3, 2 + 3 + 6},
               {{{0.15, Matching::plane, 4, 3, false}, {0.035, Matching::projective, 4, 4, true}},
                5 + 8,
                7 + 12}};
  for (const auto& c : cases) {
    AlignmentSettings settings = settings_with_gates(c.gates);
    settings.convergence_translation_m = settings.convergence_rotation_rad = -1;  // never converges
    EXPECT_EQ(AlignmentRun::slices_max(settings, 1), c.one_view);
    EXPECT_EQ(AlignmentRun::slices_max(settings, 2), c.two_views);
    if (c.gates[0].matching != Matching::projective) continue;  // may converge earlier
    const std::vector<SceneView> views = scene.views();
    for (const std::size_t count : {1u, 2u}) {
      AlignmentRun run;
      run.start(k_truth, settings);
      int slices = 1;
      while (run.step(std::span(views).first(count), scene.scratch)) ++slices;
      EXPECT_EQ(slices, count == 1 ? c.one_view : c.two_views);
    }
  }
}

TEST(AlignSteps, AreCountedWithinTheirLimits) {
  const auto slices = [](int steps_max, bool render_each, int gate_count) {
    AlignmentSettings settings;
    for (Gate& gate : settings.gates) {
      gate = {0.035, Matching::projective, 1, steps_max, render_each};
    }
    settings.gate_count = gate_count;
    return AlignmentRun::slices_max(settings, 1);
  };
  EXPECT_EQ(slices(k_alignment_steps_max + 40, false, 1), k_alignment_steps_max + 1);
  EXPECT_EQ(slices(-5, false, 1), 1);
  EXPECT_EQ(slices(0, true, 1), 1) << "at least one";
  EXPECT_EQ(slices(1, false, 0), 1);
  EXPECT_EQ(slices(1, false, -3), 1);
  EXPECT_EQ(slices(1, false, k_gates_max), 2 * k_gates_max);
  EXPECT_EQ(slices(1, false, k_gates_max + 5), 2 * k_gates_max);
}

// Rendering triangles takes no steps of the budget. The rest: each visible point once for the
// centroid and once per step for its pair, and the solution of each step.
TEST(AlignSteps, TakeTheirStepsFromTheBudgetInSlicesOfAnySize) {
  TwoViews scene(0.004);
  constexpr int k_steps = 3;
  Gate gate = k_projective;
  gate.step = 3;
  gate.steps_max = k_steps;
  AlignmentSettings settings = settings_with_gates({gate});
  settings.convergence_translation_m = settings.convergence_rotation_rad = -1;  // never converges
  const std::vector<SceneView> views = scene.views();
  for (const int budget : {1, 1'000, SliceSize::k_steps_max}) {
    AlignmentRun run;
    run.start(k_truth, settings);
    int steps = 0;
    for (bool more = true; more;) {
      StepBudget left(budget);
      more = run.step(views, left, scene.scratch);
      steps += budget - left.left();
      ASSERT_LE(budget - left.left(), budget + k_pair_steps + k_solve_steps);
    }
    const int seen = scene.scratch.views[0].visible_count + scene.scratch.views[1].visible_count;
    EXPECT_GT(seen, 300);
    EXPECT_EQ(steps, seen * (k_centroid_steps + k_steps * k_pair_steps) + k_steps * k_solve_steps)
        << budget;
  }
}

// Search grid of the scene's measured pixels: every second row and column if `step` is above 2.
TEST(AlignSteps, SearchTheSceneNoThinnerThanEveryOtherPixel) {
  TwoViews scene(0.001);
  for (const int step : {1, 2, 3, 5}) {
    Gate gate{0.15, Matching::plane, step, 1, false};
    (void)align_model(scene.views(), k_truth, settings_with_gates({gate}), scene.scratch);
    for (const AlignmentScratch::View& view : scene.scratch.views) {
      EXPECT_EQ(view.grid.size(), step > 2 ? k_pixels / 4 : k_pixels) << step;
    }
  }
}

TEST(AlignSteps, OfNoGateLeaveThePoseAndOfAnEmptyOneGoOnToTheNext) {
  TwoViews scene(0.004);
  for (const int count : {0, -1}) {
    AlignmentSettings settings;
    settings.gate_count = count;
    const ModelAlignment none = align_model(scene.views(), start_off(), settings, scene.scratch);
    EXPECT_EQ(none.reason, Reason::none);
    EXPECT_EQ(none.steps, 0);
    EXPECT_EQ(none.pairs, 0);
    EXPECT_EQ(none.T_world_base.translation, start_off().translation);
    EXPECT_EQ(none.covariance, Matrix6(Matrix6::Zero()));
  }
  Gate some = k_projective, empty = k_projective;
  some.steps_max = 3;
  empty.steps_max = 0;
  const ModelAlignment one =
      align_model(scene.views(), start_off(), settings_with_gates({some}), scene.scratch);
  const ModelAlignment two =
      align_model(scene.views(), start_off(), settings_with_gates({empty, some}), scene.scratch);
  EXPECT_EQ(one.steps, two.steps);
  EXPECT_EQ(one.T_world_base.translation, two.T_world_base.translation);
  EXPECT_EQ(one.covariance, two.covariance);
}

// Six pairs determine the pose without redundancy: there is no residual variance.
TEST(AlignSteps, HaveNoCovarianceOfSixPairs) {
  TwoViews scene(0.004);
  const std::vector<float> whole = scene.depth[0];
  std::vector<std::size_t> on_model;
  for (std::size_t i = 0; i < whole.size(); ++i) {
    if (whole[i] < 1.8f) on_model.push_back(i);
  }
  Gate gate = k_projective;
  gate.gate_m = 0.1;
  std::mt19937 random(3);
  int posed = 0;
  for (int round = 0; round < 60; ++round) {
    const int pixels = 6 + round % 2;
    scene.depth[0].assign(k_pixels, 0);
    for (int i = 0; i < pixels; ++i) {
      const std::size_t pixel = on_model[random() % on_model.size()];
      scene.depth[0][pixel] = whole[pixel];
    }
    const std::vector<SceneView> views = scene.views();
    const ModelAlignment end =
        align_model(std::span(views).first(1), k_truth, settings_with_gates({gate}), scene.scratch);
    if (end.reason != Reason::none) continue;  // the pairs do not determine a pose
    ++posed;
    EXPECT_EQ(end.covariance.norm() > 0, end.pairs > 6) << end.pairs;
    EXPECT_GE(end.pairs, 6);
  }
  EXPECT_GT(posed, 4);
}

TEST(AlignSteps, StartedAnewAreThoseOfANewRun) {
  TwoViews scene(0.004);
  const std::vector<SceneView> views = scene.views();
  AlignmentRun used, fresh;
  used.start({Quaternion::Identity(), {0, 0, -3}},
             settings_with_gates({k_projective, k_projective}));
  while (used.step(views, scene.scratch)) {
  }
  EXPECT_EQ(used.result().reason, Reason::degenerate);
  EXPECT_EQ(used.result().steps, 1) << "and goes to no further gate";
  EXPECT_EQ(used.result().pairs, 0);
  EXPECT_FALSE(used.step(views, scene.scratch)) << "it has ended";
  Gate more = k_projective;
  more.steps_max = 4;
  for (const int slices : {1, 2, 5}) {  // interrupted
    used.start(start_off(), settings_with_gates({more, more}));
    for (int i = 0; i < slices; ++i) EXPECT_TRUE(used.step(views, scene.scratch));
    for (AlignmentRun* run : {&used, &fresh}) {
      run->start(start_off(), settings_with_gates({more, k_projective}));
      while (run->step(views, scene.scratch)) {
      }
    }
    EXPECT_EQ(used.result().steps, fresh.result().steps);
    EXPECT_EQ(used.result().pairs, fresh.result().pairs);
    EXPECT_EQ(used.result().reason, Reason::none);
    EXPECT_EQ(used.result().T_world_base.translation, fresh.result().T_world_base.translation);
    EXPECT_EQ(used.result().covariance, fresh.result().covariance);
    EXPECT_EQ(used.centroid(), fresh.centroid());
  }
}

}  // namespace
}  // namespace glint::align_steps_test
