#include "kernels/registration/align_model.hpp"

#include <algorithm>
#include <cmath>

namespace glint {
namespace {

Matrix6 covariance_of(const AlignmentSums& sums, const Vector3& centroid,
                      const Pose& T_world_base) noexcept {
  const Result<PoseFactor> factor = pose_factor(sums.matrix);
  if (!factor || sums.count <= 6) return Matrix6::Zero();
  // Motion of the base's origin: shift + turn x (origin - middle).
  const Vector3 l = T_world_base.translation - centroid;
  Matrix6 to_origin = Matrix6::Identity();
  to_origin.topRightCorner<3, 3>() << 0, l.z(), -l.y(), -l.z(), 0, l.x(), l.y(), -l.x(), 0;
  const Matrix6 about_middle = factor.value.inverse() * (sums.squares / (sums.count - 6));
  return to_origin * about_middle * to_origin.transpose();
}

int gates_of(const AlignmentSettings& settings) noexcept {
  return std::clamp(settings.gate_count, 0, k_gates_max);
}

}  // namespace

int AlignmentRun::slices_max(const AlignmentSettings& settings, int views) noexcept {
  int slices = 0;
  for (int g = 0; g < gates_of(settings); ++g) {
    const Gate& gate = settings.gates[static_cast<std::size_t>(g)];
    const int steps = std::clamp(gate.steps_max, 0, k_alignment_steps_max);
    const int grids = gate.matching == Matching::projective ? 0 : views;
    slices += grids + steps + (gate.render_each ? steps : 1) * views;
  }
  return std::max(slices, 1);
}

void AlignmentRun::start(const Pose& T_world_base, const AlignmentSettings& settings) noexcept {
  settings_ = settings;
  result_ = ModelAlignment{};
  result_.T_world_base = T_world_base;
  number_ = 0;
  phase_ = Phase::begin;
}

bool AlignmentRun::step(std::span<const SceneView> views, AlignmentScratch& scratch) noexcept {
  bool more = true, slice_complete = false;
  for (StepBudget all; more && !slice_complete; all = StepBudget()) {
    more = step(views, all, scratch);
    slice_complete = phase_ == Phase::grid || phase_ == Phase::start_view ||
                     (phase_ == Phase::pair && view_ == 0 && at_ == 0);
  }
  return more;
}

bool AlignmentRun::step(std::span<const SceneView> views, StepBudget& budget,
                        AlignmentScratch& scratch) noexcept {
  if (phase_ == Phase::begin) {
    if (!scene_fits(views, scratch)) {
      result_.reason = Reason::not_prepared;
      phase_ = Phase::done;
      return false;
    }
    begin_gate();
  }
  if (phase_ == Phase::grid) {
    // Subsamples the scene by at most 2, so that pairs are apart mainly along the normal.
    index_scene(views[view_], gate_.step > 2 ? 2 : 1, gate_.gate_m, scratch.views[view_]);
    if (++view_ < views.size()) return true;
    view_ = 0;
    phase_ = Phase::start_view;
    return true;
  }
  if (phase_ == Phase::start_view) start_view(views, scratch);
  if (phase_ == Phase::render) {
    if (!rendering_.step(budget, scratch.views[view_])) return true;
    phase_ = Phase::centroid;
  } else if (phase_ == Phase::centroid) {
    find_centroid(views, budget, scratch);
  } else if (phase_ == Phase::pair) {
    pair(views, budget, scratch);
  }
  return phase_ != Phase::done;
}

void AlignmentRun::start_view(std::span<const SceneView> views,
                              AlignmentScratch& scratch) noexcept {
  if (view_ == 0) {
    T_world_rendered_ = result_.T_world_base;
    total_sum_ = Vector3::Zero();
    visible_count_ = 0;
  }
  rendering_.start(views[view_], T_world_rendered_, gate_.step, scratch.views[view_]);
  view_sum_ = Vector3::Zero();
  at_ = 0;
  phase_ = Phase::render;
}

// Centroid of the visible points in the world frame: rotations about it move the points least.
void AlignmentRun::find_centroid(std::span<const SceneView> views, StepBudget& budget,
                                 const AlignmentScratch& scratch) noexcept {
  const AlignmentScratch::View& memory = scratch.views[view_];
  for (const int end = budget.take_items(at_, memory.visible_count, k_centroid_steps); at_ < end;
       ++at_) {
    view_sum_ += memory.seen[static_cast<std::size_t>(at_)].point.cast<double>();
  }
  if (at_ < memory.visible_count) return;
  const Pose T_world_camera = views[view_].T_camera_world.inverse();
  total_sum_ +=
      T_world_camera.rotation * view_sum_ + memory.visible_count * T_world_camera.translation;
  visible_count_ += memory.visible_count;
  phase_ = Phase::start_view;
  if (++view_ < views.size()) return;
  view_ = 0;
  centroid_ = visible_count_ > 0 ? Vector3(total_sum_ / visible_count_) : total_sum_;
  begin_pairs();
}

void AlignmentRun::begin_pairs() noexcept {
  at_ = 0;
  sums_ = AlignmentSums{};
  phase_ = Phase::pair;
}

void AlignmentRun::pair(std::span<const SceneView> views, StepBudget& budget,
                        const AlignmentScratch& scratch) noexcept {
  // Motion of the model in the world since its rendering.
  const Pose T_world_since = result_.T_world_base * T_world_rendered_.inverse();
  const AlignmentScratch::View& memory = scratch.views[view_];
  const Pose& T_camera_world = views[view_].T_camera_world;
  const Pose T_world_camera = T_camera_world.inverse();
  const int end = budget.take_items(at_, memory.visible_count, k_pair_steps);
  add_pairs(std::span(memory.seen)
                .subspan(static_cast<std::size_t>(at_), static_cast<std::size_t>(end - at_)),
            T_camera_world * T_world_since * T_world_camera, gate_.matching, gate_.gate_m,
            views[view_], {&memory.grid, memory.scene}, T_world_camera.rotation,
            T_camera_world * centroid_, sums_);
  at_ = end;
  if (at_ < memory.visible_count) return;
  at_ = 0;
  if (++view_ < views.size()) return;
  view_ = 0;
  budget.take(k_solve_steps);
  move();
}

void AlignmentRun::begin_gate() noexcept {
  while (number_ < gates_of(settings_)) {
    gate_ = settings_.gates[static_cast<std::size_t>(number_)];
    gate_.steps_max = std::min(gate_.steps_max, k_alignment_steps_max);
    step_ = 0;
    view_ = 0;
    phase_ = gate_.matching == Matching::projective ? Phase::start_view : Phase::grid;
    if (gate_.steps_max > 0) return;
    ++number_;
  }
  phase_ = Phase::done;
}

void AlignmentRun::move() noexcept {
  const Result<AlignmentStep> step = solve(sums_);
  ++result_.steps;
  if (!step) {
    result_.reason = Reason::degenerate;
    phase_ = Phase::done;
    return;
  }
  result_.T_world_base = moved(result_.T_world_base, step.value, centroid_);
  const double wide = gate_.matching == Matching::projective ? 0 : gate_.gate_m / 50;
  const bool converged =
      step.value.translation.norm() < std::max(wide, settings_.convergence_translation_m) &&
      step.value.rotation.norm() < std::max(wide, settings_.convergence_rotation_rad);
  if (converged || ++step_ == gate_.steps_max) {
    end_gate(sums_);
  } else if (gate_.render_each) {
    phase_ = Phase::start_view;
  } else {
    begin_pairs();
  }
}

void AlignmentRun::end_gate(const AlignmentSums& sums) noexcept {
  if (number_ + 1 == gates_of(settings_)) {
    result_.covariance = covariance_of(sums, centroid_, result_.T_world_base);
    result_.pairs = sums.count;
    result_.residual_m = sums.count > 0 ? std::sqrt(sums.squares / sums.count) : 0;
  }
  ++number_;
  begin_gate();
}

ModelAlignment align_model(std::span<const SceneView> views, const Pose& T_world_base,
                           const AlignmentSettings& settings, AlignmentScratch& scratch) noexcept {
  AlignmentRun run;
  run.start(T_world_base, settings);
  const int slices = AlignmentRun::slices_max(settings, static_cast<int>(views.size()));
  for (int slice = 0; slice < slices && run.step(views, scratch); ++slice) {
  }
  return run.result();
}

}  // namespace glint
