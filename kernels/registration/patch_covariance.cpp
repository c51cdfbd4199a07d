#include "kernels/registration/patch_covariance.hpp"

#include <algorithm>

#include "kernels/registration/match_points.hpp"

namespace glint {
namespace {

int patch_of(std::int32_t pixel, int width) noexcept {
  const int across = (width + k_patch_pixels - 1) / k_patch_pixels;
  return pixel / width / k_patch_pixels * across + pixel % width / k_patch_pixels;
}

// Sum of J'r of each patch, and sums of the view.
void add_patches(const SceneView& view, const Pose& T_world_base, double gate_m,
                 AlignmentScratch::View& memory, AlignmentSums& all) noexcept {
  render_model(view, T_world_base, 1, memory);
  const Pose T_world_camera = view.T_camera_world.inverse();
  const Vector3 origin = view.T_camera_world * T_world_base.translation;
  std::fill(memory.patches.begin(), memory.patches.end(), Vector6::Zero());
  const int width = view.camera.width;
  // Adds consecutive points of one patch together.
  for (int from = 0, to = 0; from < memory.visible_count; from = to) {
    const int patch = patch_of(memory.seen[static_cast<std::size_t>(from)].pixel, width);
    while (to < memory.visible_count &&
           patch_of(memory.seen[static_cast<std::size_t>(to)].pixel, width) == patch) {
      ++to;
    }
    AlignmentSums some;
    add_pairs(std::span(memory.seen)
                  .subspan(static_cast<std::size_t>(from), static_cast<std::size_t>(to - from)),
              Pose{}, Matching::projective, gate_m, view, {}, T_world_camera.rotation, origin,
              some);
    all.matrix += some.matrix;
    memory.patches[static_cast<std::size_t>(patch)] += some.slope;
  }
}

}  // namespace

Result<Matrix6> patch_covariance(std::span<const SceneView> views, const Pose& T_world_base,
                                 double gate_m, AlignmentScratch& scratch) noexcept {
  if (!scene_fits(views, scratch)) return {{}, Reason::not_prepared};
  AlignmentSums all;
  Matrix6 spread = Matrix6::Zero();
  int patches = 0;
  for (std::size_t v = 0; v < views.size(); ++v) {
    add_patches(views[v], T_world_base, gate_m, scratch.views[v], all);
    for (const Vector6& sum : scratch.views[v].patches) {
      if (!(sum.squaredNorm() > 0)) continue;  // no pair in the patch
      spread += sum * sum.transpose();
      ++patches;
    }
  }
  const Result<PoseFactor> factor = pose_factor(all.matrix);
  if (!factor || patches < k_patches_min) return {{}, Reason::degenerate};
  const Matrix6 inverse = factor.value.inverse();
  const double dof_factor = static_cast<double>(patches) / (patches - 6);
  return {dof_factor * inverse * spread * inverse, Reason::none};
}

}  // namespace glint
