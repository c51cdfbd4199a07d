#include "kernels/registration/judge_links.hpp"

namespace glint {
namespace {

void count_links(const SceneView& view, std::span<const std::uint16_t> numbers,
                 const ScoreSettings& settings, const AlignmentScratch::View& memory,
                 LinkScores& judgement) noexcept {
  for (int i = 0; i < memory.visible_count; ++i) {
    const VisiblePoint& seen = memory.seen[static_cast<std::size_t>(i)];
    const auto pixel = static_cast<std::size_t>(seen.pixel);
    const auto part = static_cast<std::size_t>(memory.triangle[pixel]);
    if (part >= numbers.size() || numbers[part] >= judgement.links.size()) continue;
    const float z = view.depth_m[pixel];
    if (!(z > 0)) continue;
    const double behind = static_cast<double>(z - seen.point.z());
    const bool something_else = !view.may_be_model(pixel) && behind < 0;
    if (something_else || behind < -settings.far_m) continue;
    LinkCounts& link = judgement.links[numbers[part]];
    ++link.looked_at;
    link.free_space_violations += behind > settings.far_m ? 1 : 0;
    const Nearest nearest = memory.grid.nearest(seen.point, static_cast<float>(settings.inlier_m));
    link.explained += nearest.index >= 0 ? 1 : 0;
  }
}

}  // namespace

LinkScores score_links(std::span<const SceneView> views,
                       std::span<const std::span<const std::uint16_t>> link_numbers,
                       const Pose& T_world_base, const ScoreSettings& settings,
                       AlignmentScratch& scratch) noexcept {
  LinkScores judgement;
  if (!scene_fits(views, scratch)) {
    judgement.reason = Reason::not_prepared;
    return judgement;
  }
  for (std::size_t v = 0; v < views.size() && v < link_numbers.size(); ++v) {
    if (link_numbers[v].empty()) continue;
    AlignmentScratch::View& memory = scratch.views[v];
    index_scene(views[v], 1, settings.inlier_m, memory);
    render_model(views[v], T_world_base, 1, memory);
    count_links(views[v], link_numbers[v], settings, memory, judgement);
  }
  return judgement;
}

}  // namespace glint
