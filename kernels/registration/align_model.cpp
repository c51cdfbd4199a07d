#include "kernels/registration/align_model.hpp"

#include <algorithm>
#include <cmath>

namespace glint {
namespace {

// The middle of what is seen, in the world: turns about it move it least.
Vector3 middle_of(std::span<const SceneView> views, const AlignmentScratch& scratch) noexcept {
  Vector3 sum = Vector3::Zero();
  int count = 0;
  for (std::size_t v = 0; v < views.size(); ++v) {
    const AlignmentScratch::View& memory = scratch.views[v];
    Vector3 of_view = Vector3::Zero();
    for (int i = 0; i < memory.seen_count; ++i) {
      of_view += memory.seen[static_cast<std::size_t>(i)].point.cast<double>();
    }
    if (memory.seen_count == 0) continue;
    const Pose T_world_camera = views[v].T_camera_world.inverse();
    sum += T_world_camera.rotation * of_view + memory.seen_count * T_world_camera.translation;
    count += memory.seen_count;
  }
  return count > 0 ? Vector3(sum / count) : sum;
}

// T_world_since: how the model moved in the world since it was rendered.
AlignmentSums sums_of(std::span<const SceneView> views, const Pose& T_world_since,
                      const Vector3& middle, const Gate& gate,
                      const AlignmentScratch& scratch) noexcept {
  AlignmentSums sums;
  for (std::size_t v = 0; v < views.size(); ++v) {
    const AlignmentScratch::View& memory = scratch.views[v];
    const Pose& T_camera_world = views[v].T_camera_world;
    const Pose T_world_camera = T_camera_world.inverse();
    add_pairs(std::span(memory.seen).first(static_cast<std::size_t>(memory.seen_count)),
              T_camera_world * T_world_since * T_world_camera, gate.matching, gate.gate_m, views[v],
              {&memory.grid, memory.scene}, T_world_camera.rotation, T_camera_world * middle, sums);
  }
  return sums;
}

Matrix6 covariance_of(const AlignmentSums& sums, const Vector3& middle,
                      const Pose& T_world_base) noexcept {
  const Result<PoseFactor> factor = pose_factor(sums.matrix);
  if (!factor || sums.count <= 6) return Matrix6::Zero();
  // The base's origin moves by shift + turn x (origin - middle).
  const Vector3 l = T_world_base.translation - middle;
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
  if (phase_ == Phase::begin) {
    if (!scene_fits(views, scratch)) {
      result_.reason = Reason::not_prepared;
      phase_ = Phase::done;
      return false;
    }
    begin_gate();
  }
  if (phase_ == Phase::grid) {
    // No thinner than every other pixel: pairs are then apart mostly along the normal.
    search_scene(views[view_], gate_.step > 2 ? 2 : 1, gate_.gate_m, scratch.views[view_]);
    if (++view_ < views.size()) return true;
    view_ = 0;
    phase_ = Phase::render;
  } else if (phase_ == Phase::render) {
    if (view_ == 0) T_world_rendered_ = result_.T_world_base;
    render_model(views[view_], T_world_rendered_, gate_.step, scratch.views[view_]);
    if (++view_ < views.size()) return true;
    view_ = 0;
    middle_ = middle_of(views, scratch);
    phase_ = Phase::move;
  } else if (phase_ == Phase::move) {
    move(views, scratch);
  }
  return phase_ != Phase::done;
}

void AlignmentRun::begin_gate() noexcept {
  while (number_ < gates_of(settings_)) {
    gate_ = settings_.gates[static_cast<std::size_t>(number_)];
    gate_.steps_max = std::min(gate_.steps_max, k_alignment_steps_max);
    step_ = 0;
    view_ = 0;
    phase_ = gate_.matching == Matching::projective ? Phase::render : Phase::grid;
    if (gate_.steps_max > 0) return;
    ++number_;
  }
  phase_ = Phase::done;
}

void AlignmentRun::move(std::span<const SceneView> views,
                        const AlignmentScratch& scratch) noexcept {
  const Pose T_world_since = result_.T_world_base * T_world_rendered_.inverse();
  const AlignmentSums sums = sums_of(views, T_world_since, middle_, gate_, scratch);
  const Result<AlignmentStep> step = solve(sums);
  ++result_.steps;
  if (!step) {
    result_.reason = Reason::degenerate;
    phase_ = Phase::done;
    return;
  }
  result_.T_world_base = moved(result_.T_world_base, step.value, middle_);
  const double wide = gate_.matching == Matching::projective ? 0 : gate_.gate_m / 50;
  const bool rests = step.value.shift.norm() < std::max(wide, settings_.rest_shift_m) &&
                     step.value.turn.norm() < std::max(wide, settings_.rest_turn_rad);
  if (rests || ++step_ == gate_.steps_max) {
    end_gate(sums);
  } else if (gate_.render_each) {
    phase_ = Phase::render;
  }
}

void AlignmentRun::end_gate(const AlignmentSums& sums) noexcept {
  if (number_ + 1 == gates_of(settings_)) {
    result_.covariance = covariance_of(sums, middle_, result_.T_world_base);
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
