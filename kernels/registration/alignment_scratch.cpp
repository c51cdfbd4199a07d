#include "kernels/registration/alignment_scratch.hpp"

#include "kernels/registration/splat_cloud.hpp"

namespace glint {
namespace {

std::size_t pixels_of(const SceneView& view) noexcept {
  return static_cast<std::size_t>(view.camera.width) * static_cast<std::size_t>(view.camera.height);
}

}  // namespace

Reason AlignmentScratch::prepare(int view_count, int pixels, int corners) {
  if (view_count < 1 || view_count > k_scene_views_max || pixels < 1 ||
      pixels > k_scene_pixels_max || corners < 1 || corners > k_scene_corners_max) {
    return Reason::out_of_range;
  }
  views.resize(static_cast<std::size_t>(view_count));
  for (View& view : views) {
    const auto size = static_cast<std::size_t>(pixels);
    view.z.resize(size);
    view.triangle.resize(size);
    view.corners.resize(static_cast<std::size_t>(corners));
    view.seen.resize(size);
    view.scene.resize(size);
    view.patches.resize(size / 16 + 1);
    if (const Reason reason = view.grid.prepare(pixels); reason != Reason::none) return reason;
  }
  return Reason::none;
}

bool scene_fits(std::span<const SceneView> views, const AlignmentScratch& scratch) noexcept {
  if (views.empty() || views.size() > scratch.views.size()) return false;
  for (std::size_t v = 0; v < views.size(); ++v) {
    const std::size_t pixels = pixels_of(views[v]);
    if (views[v].camera.width < 1 || views[v].camera.height < 1 || pixels == 0 ||
        pixels > scratch.views[v].z.size() || views[v].depth_m.size() != pixels ||
        views[v].model.corners.size() > scratch.views[v].corners.size() ||
        views[v].cloud.points.size() > scratch.views[v].corners.size() ||
        views[v].cloud.points.size() != views[v].cloud.normals.size() ||
        (!views[v].mask.empty() && views[v].mask.size() != pixels)) {
      return false;
    }
  }
  return true;
}

void render_model(const SceneView& view, const Pose& T_world_base, int step,
                  AlignmentScratch::View& memory) noexcept {
  ModelRendering run;
  run.start(view, T_world_base, step, memory);
  for (StepBudget all; !run.step(all, memory); all = StepBudget()) {
  }
}

void ModelRendering::start(const SceneView& view, const Pose& T_world_base, int step,
                           AlignmentScratch::View& memory) noexcept {
  const DepthBuffer buffer{std::span(memory.z).first(pixels_of(view)),
                           std::span(memory.triangle).first(pixels_of(view)), memory.corners};
  const Pose T_camera_base = view.T_camera_world * T_world_base;
  of_points_ = !view.cloud.points.empty();
  if (of_points_) {
    (void)splat_.start(view.cloud, T_camera_base, view.camera, step, buffer, memory.seen);
  } else {
    memory.visible_count = visible_points(view, T_camera_base, step, buffer, memory.seen);
  }
}

bool ModelRendering::step(StepBudget& budget, AlignmentScratch::View& memory) noexcept {
  if (!of_points_) return true;
  if (!splat_.step(budget)) return false;
  memory.visible_count = splat_.count();
  return true;
}

void index_scene(const SceneView& view, int step, double reach_m,
                 AlignmentScratch::View& memory) noexcept {
  std::size_t count = 0;
  for (int y = 0; y < view.camera.height; y += step) {
    for (int x = 0; x < view.camera.width; x += step) {
      const auto pixel = static_cast<std::size_t>(y * view.camera.width + x);
      const float z = view.depth_m[pixel];
      if (!(z > 0) || !view.may_be_model(pixel)) continue;
      memory.scene[count++] = pixel_point(view.camera, x, y, z);
    }
  }
  (void)memory.grid.build(std::span(memory.scene).first(count), reach_m);
}

void SceneIndexing::start() noexcept {
  at_ = 0;
  count_ = 0;
  building_ = false;
}

bool SceneIndexing::step(const SceneView& view, double reach_m, StepBudget& budget,
                         AlignmentScratch::View& memory) noexcept {
  if (building_) return memory.grid.build_step(budget);
  const auto pixels = static_cast<int>(pixels_of(view));
  for (const int end = budget.take_items(at_, pixels, k_scene_pixel_steps); at_ < end; ++at_) {
    const auto pixel = static_cast<std::size_t>(at_);
    const float z = view.depth_m[pixel];
    if (!(z > 0) || !view.may_be_model(pixel)) continue;
    memory.scene[count_++] =
        pixel_point(view.camera, at_ % view.camera.width, at_ / view.camera.width, z);
  }
  if (at_ < pixels) return false;
  (void)memory.grid.begin_build(std::span(memory.scene).first(count_), reach_m);
  building_ = true;
  return false;
}

}  // namespace glint
