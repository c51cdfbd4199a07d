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

}  // namespace

ModelAlignment align_model(std::span<const SceneView> views, const Pose& T_world_base,
                           const AlignmentSettings& settings, AlignmentScratch& scratch) noexcept {
  ModelAlignment result;
  result.T_world_base = T_world_base;
  if (!scene_fits(views, scratch)) {
    result.reason = Reason::not_prepared;
    return result;
  }
  const int gates = std::min(settings.gate_count, k_gates_max);
  for (int g = 0; g < gates; ++g) {
    const Gate& gate = settings.gates[static_cast<std::size_t>(g)];
    const int steps = std::min(gate.steps_max, k_alignment_steps_max);
    if (gate.matching != Matching::projective) {
      // No thinner than every other pixel: pairs are then apart mostly along the normal.
      const int thin = gate.step > 2 ? 2 : 1;
      for (std::size_t v = 0; v < views.size(); ++v) {
        search_scene(views[v], thin, gate.gate_m, scratch.views[v]);
      }
    }
    Pose T_world_rendered;
    AlignmentSums sums;
    Vector3 middle = Vector3::Zero();
    for (int s = 0; s < steps; ++s) {
      if (s == 0 || gate.render_each) {
        T_world_rendered = result.T_world_base;
        for (std::size_t v = 0; v < views.size(); ++v) {
          render_model(views[v], T_world_rendered, gate.step, scratch.views[v]);
        }
        middle = middle_of(views, scratch);
      }
      const Pose T_world_since = result.T_world_base * T_world_rendered.inverse();
      sums = sums_of(views, T_world_since, middle, gate, scratch);
      const Result<AlignmentStep> step = solve(sums);
      ++result.steps;
      if (!step) {
        result.reason = Reason::degenerate;
        return result;
      }
      result.T_world_base = moved(result.T_world_base, step.value, middle);
      const double wide = gate.matching == Matching::projective ? 0 : gate.gate_m / 50;
      const bool rests = step.value.shift.norm() < std::max(wide, settings.rest_shift_m) &&
                         step.value.turn.norm() < std::max(wide, settings.rest_turn_rad);
      if (rests) break;
    }
    if (g + 1 == gates) {
      result.covariance = covariance_of(sums, middle, result.T_world_base);
      result.pairs = sums.count;
      result.residual_m = sums.count > 0 ? std::sqrt(sums.squares / sums.count) : 0;
    }
  }
  return result;
}

}  // namespace glint
