// Registration of a model to depth images from an initial pose: coarse-to-fine ICP over several
// views at once, with covariance.
//
// What:     at each gate renders the model at its current pose, pairs the visible points with the
//           scene's (match_points.hpp), and moves the model by Gauss-Newton until it converges.
//           Gates with render_each render again at each step. Sums run view by view, point by
//           point.
// Cost:     gates * steps * points pairs, and one rendering per gate and view.
// Worst:    an initial pose without convergence: steps_max at each gate.
// Accuracy: on simulated depth with 1 % noise about that of its own covariance; see the experiment
//           "reference".
// Source:   Besl and McKay 1992. Rendering at the current estimate makes the optimum unbiased: with
//           the whole model it is centimetres off.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "kernels/registration/alignment_scratch.hpp"
#include "kernels/registration/match_points.hpp"

namespace glint {

inline constexpr int k_gates_max = 8;
inline constexpr int k_alignment_steps_max = 60;
// Steps per pair of points; per Gauss-Newton step without its pairs.
inline constexpr int k_pair_steps = 80, k_solve_steps = 4000;
inline constexpr int k_centroid_steps = 4;  // per point of the centroid

struct Gate {
  double gate_m = 0;
  Matching matching = Matching::plane;
  int step = 1;        // pixels from one model point to the next, in both directions
  int steps_max = 10;  // of Gauss-Newton
  bool render_each = false;
};

struct AlignmentSettings {
  std::array<Gate, k_gates_max> gates{
      {{0.15, Matching::plane, 4, 12, false},
       {0.08, Matching::plane, 3, 12, false},
       {0.04, Matching::plane, 2, 12, false},
       {0.04, Matching::projective, 1, 6, true},
       {0.035, Matching::projective, 1, 12, true}}};  // 3 sigma of 1 % at 1.2 m
  int gate_count = 5;
  // Convergence limits of a step, both required. Point and plane gates use at least gate_m / 50.
  double convergence_translation_m = 1e-4;
  double convergence_rotation_rad = 1e-4;
};

struct ModelAlignment {
  Pose T_world_base;
  Matrix6 covariance = Matrix6::Zero();  // translation, rotation at the base's origin, world axes
  double residual_m = 0;                 // RMS at the last gate
  int pairs = 0;
  int steps = 0;
  Reason reason = Reason::none;  // degenerate: too little visible for a pose
};

// An alignment in slices: call step() with the same views and scratch until it returns false. A
// slice is a grid or a rendering of one view, or one Gauss-Newton step over all views. With a
// budget a slice is a part of these that exceeds the budget's steps by at most one point's, if the
// model is a point cloud and all gates are projective.
class AlignmentRun {
 public:
  // Largest number of slices.
  [[nodiscard]] static int slices_max(const AlignmentSettings& settings, int views) noexcept;

  void start(const Pose& T_world_base,
             const AlignmentSettings& settings) noexcept GLINT_NONBLOCKING;
  [[nodiscard]] bool step(std::span<const SceneView> views,
                          AlignmentScratch& scratch) noexcept GLINT_NONBLOCKING;
  [[nodiscard]] bool step(std::span<const SceneView> views, StepBudget& budget,
                          AlignmentScratch& scratch) noexcept GLINT_NONBLOCKING;

  // Complete once step() has returned false.
  [[nodiscard]] const ModelAlignment& result() const noexcept { return result_; }
  // Centroid of the points visible at the last rendering, in the world frame; rotations are about
  // it.
  [[nodiscard]] const Vector3& centroid() const noexcept { return centroid_; }

 private:
  enum class Phase : std::uint8_t { begin, grid, start_view, render, centroid, pair, done };

  void begin_gate() noexcept;
  void start_view(std::span<const SceneView> views, AlignmentScratch& scratch) noexcept;
  void find_centroid(std::span<const SceneView> views, StepBudget& budget,
                     const AlignmentScratch& scratch) noexcept;
  void pair(std::span<const SceneView> views, StepBudget& budget,
            const AlignmentScratch& scratch) noexcept;
  void begin_pairs() noexcept;
  void move() noexcept;
  void end_gate(const AlignmentSums& sums) noexcept;

  AlignmentSettings settings_;
  ModelAlignment result_;
  Pose T_world_rendered_;
  Vector3 centroid_ = Vector3::Zero();
  Gate gate_;
  Phase phase_ = Phase::done;
  int number_ = 0, step_ = 0;  // of the gate, and within it
  std::size_t view_ = 0;
  int at_ = 0;  // index of the view's points
  ModelRendering rendering_;
  Vector3 view_sum_ = Vector3::Zero(), total_sum_ = Vector3::Zero();  // sums of the visible points
  int visible_count_ = 0;
  AlignmentSums sums_;
};

// Runs all slices. Reason::not_prepared: the scratch is too small for the views.
[[nodiscard]] ModelAlignment align_model(std::span<const SceneView> views, const Pose& T_world_base,
                                         const AlignmentSettings& settings,
                                         AlignmentScratch& scratch) noexcept GLINT_NONBLOCKING;

}  // namespace glint
