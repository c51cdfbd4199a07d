// The pose of a model in a scene, from a rough one: coarse to fine, over several views at once.
//
// What:     at each gate the model is rendered where it stands, the points that can be seen are
//           paired with the scene's (match_points.hpp), and Gauss-Newton moves the model until it
//           rests. The last stage renders anew at each step. Sums go view by view, point by point.
// Cost:     gates * steps * points pairs, and a rendering a gate and view.
// Worst:    a start from which it does not come to rest: steps_max at each gate.
// Accuracy: on simulated depth with 1 % noise about its own covariance's; see the experiment
//           "reference".
// Source:   Besl and McKay 1992; the rendering at the present guess is what makes its optimum
//           right, with the whole model it lies centimetres off.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "kernels/registration/alignment_scratch.hpp"
#include "kernels/registration/match_points.hpp"

namespace glint {

inline constexpr int k_gates_max = 8;
inline constexpr int k_alignment_steps_max = 60;
// Of a pair of points, and of a step of Gauss-Newton beside its pairs.
inline constexpr int k_pair_steps = 80, k_solve_steps = 4000;
inline constexpr int k_middle_steps = 4;  // of a point, when the middle of all is found

struct Gate {
  double gate_m = 0;
  Matching matching = Matching::plane;
  int step = 1;        // pixels of the picture from one point to the next, along both sides
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
  // A step below both is rest; while the gate is wide, below a fiftieth of it.
  double rest_shift_m = 1e-4;
  double rest_turn_rad = 1e-4;
};

struct ModelAlignment {
  Pose T_world_base;
  Matrix6 covariance = Matrix6::Zero();  // of shift and turn about the base's origin, world axes
  double residual_m = 0;                 // root of the mean square at the last gate
  int pairs = 0;
  int steps = 0;
  Reason reason = Reason::none;  // degenerate: too little was seen to fix a pose
};

// An alignment in slices: step() after step() until it says false, with the same views and scratch
// each time. A slice is a grid or a rendering of one view, or one step of Gauss-Newton over all; or
// a part of these that takes no more than the budget's steps and those of one point beyond them,
// where the model is points and all gates are projective.
class AlignmentRun {
 public:
  // How many slices it takes at most.
  [[nodiscard]] static int slices_max(const AlignmentSettings& settings, int views) noexcept;

  void start(const Pose& T_world_base,
             const AlignmentSettings& settings) noexcept GLINT_NONBLOCKING;
  [[nodiscard]] bool step(std::span<const SceneView> views,
                          AlignmentScratch& scratch) noexcept GLINT_NONBLOCKING;
  [[nodiscard]] bool step(std::span<const SceneView> views, StepBudget& budget,
                          AlignmentScratch& scratch) noexcept GLINT_NONBLOCKING;

  // Complete when step() has said false.
  [[nodiscard]] const ModelAlignment& result() const noexcept { return result_; }
  // Of what was seen at the last rendering, in the world: what turns are about.
  [[nodiscard]] const Vector3& middle() const noexcept { return middle_; }

 private:
  enum class Phase : std::uint8_t { begin, grid, start_view, render, middle, pair, done };

  void begin_gate() noexcept;
  void start_view(std::span<const SceneView> views, AlignmentScratch& scratch) noexcept;
  void find_middle(std::span<const SceneView> views, StepBudget& budget,
                   const AlignmentScratch& scratch) noexcept;
  void pair(std::span<const SceneView> views, StepBudget& budget,
            const AlignmentScratch& scratch) noexcept;
  void begin_pairs() noexcept;
  void move() noexcept;
  void end_gate(const AlignmentSums& sums) noexcept;

  AlignmentSettings settings_;
  ModelAlignment result_;
  Pose T_world_rendered_;
  Vector3 middle_ = Vector3::Zero();
  Gate gate_;
  Phase phase_ = Phase::done;
  int number_ = 0, step_ = 0;  // of the gate, and in it
  std::size_t view_ = 0;
  int at_ = 0;  // of the view's points
  ModelRendering rendering_;
  Vector3 of_view_ = Vector3::Zero(), of_all_ = Vector3::Zero();  // sums of what is seen
  int seen_ = 0;
  AlignmentSums sums_;
};

// All slices at once. Reason::not_prepared: the scratch is too small for the views.
[[nodiscard]] ModelAlignment align_model(std::span<const SceneView> views, const Pose& T_world_base,
                                         const AlignmentSettings& settings,
                                         AlignmentScratch& scratch) noexcept GLINT_NONBLOCKING;

}  // namespace glint
