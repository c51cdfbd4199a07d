#include "kernels/registration/judge_alignment.hpp"

#include <array>
#include <cmath>

namespace glint {
namespace {

struct Distances {
  std::array<int, k_distance_steps + 1> counts{};
  int count = 0;

  void add(double distance_m) noexcept {
    const double step = distance_m / k_distance_step_m;
    ++counts[step < k_distance_steps ? static_cast<std::size_t>(step) : k_distance_steps];
    ++count;
  }
  [[nodiscard]] double median_m() const noexcept {
    int below = 0;
    for (int i = 0; i <= k_distance_steps; ++i) {
      below += counts[static_cast<std::size_t>(i)];
      if (2 * below >= count) return (i + 0.5) * k_distance_step_m;
    }
    return 0;
  }
};

}  // namespace

Judgement judge_alignment(std::span<const SceneView> views, const Pose& T_world_base,
                          const JudgeSettings& settings, AlignmentScratch& scratch) noexcept {
  Judgement judgement;
  if (!scene_fits(views, scratch)) {
    judgement.reason = Reason::not_prepared;
    return judgement;
  }
  Distances distances;
  for (std::size_t v = 0; v < views.size(); ++v) {
    const SceneView& view = views[v];
    AlignmentScratch::View& memory = scratch.views[v];
    search_scene(view, 1, k_distance_steps * k_distance_step_m, memory);
    render_model(view, T_world_base, 1, memory);
    const OutlineCounts outline =
        look_beside_outline(view, memory.z, memory.triangle, settings.far_m);
    judgement.outline.falls += outline.falls;
    judgement.outline.goes_on += outline.goes_on;
    for (std::size_t pixel = 0; pixel < view.mask.size(); ++pixel) {
      if (view.mask[pixel] == 0 || !(view.depth_m[pixel] > 0)) continue;
      ++judgement.mask_pixels;
      judgement.mask_covered += memory.triangle[pixel] >= 0 ? 1 : 0;
    }
    for (int i = 0; i < memory.seen_count; ++i) {
      const SeenPoint& seen = memory.seen[static_cast<std::size_t>(i)];
      const auto pixel = static_cast<std::size_t>(seen.pixel);
      ++judgement.rendered;
      const float z = view.depth_m[pixel];
      if (!(z > 0)) continue;
      ++judgement.measured;
      const double behind = static_cast<double>(z - seen.point.z());
      // What the mask says is something else hides the model from however near.
      const bool something_else = !view.may_be_model(pixel) && behind < 0;
      if (something_else || behind < -settings.far_m) {
        ++judgement.hidden;
        continue;
      }
      if (behind > settings.far_m) ++judgement.seen_through;
      const Nearest nearest =
          memory.grid.nearest(seen.point, static_cast<float>(k_distance_steps * k_distance_step_m));
      const double distance = std::sqrt(static_cast<double>(nearest.square_m2));
      if (nearest.index >= 0 && distance <= settings.inlier_m) ++judgement.inliers;
      distances.add(distance);
    }
  }
  judgement.median_m = distances.median_m();
  return judgement;
}

}  // namespace glint
