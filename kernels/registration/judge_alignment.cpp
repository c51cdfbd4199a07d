#include "kernels/registration/judge_alignment.hpp"

#include <cmath>

namespace glint {

void AlignmentScoring::start(const Pose& T_world_base, const ScoreSettings& settings) noexcept {
  T_world_base_ = T_world_base;
  settings_ = settings;
  result_ = AlignmentScore{};
  distances_.fill(0);
  distance_count_ = 0;
  view_ = 0;
  phase_ = Phase::begin;
}

bool AlignmentScoring::step(std::span<const SceneView> views, StepBudget& budget,
                            AlignmentScratch& scratch) noexcept {
  if (phase_ == Phase::begin) {
    if (!scene_fits(views, scratch)) {
      result_.reason = Reason::not_prepared;
      phase_ = Phase::done;
      return true;
    }
    begin_view(views);
  }
  if (phase_ == Phase::done) return true;
  const SceneView& view = views[view_];
  AlignmentScratch::View& memory = scratch.views[view_];
  if (phase_ == Phase::index) {
    if (!indexing_.step(view, k_distance_steps * k_distance_step_m, budget, memory)) return false;
    rendering_.start(view, T_world_base_, 1, memory);
    phase_ = Phase::render;
  } else if (phase_ == Phase::render) {
    if (!rendering_.step(budget, memory)) return false;
    at_ = 0;
    phase_ = Phase::outline;
  } else if (phase_ == Phase::outline) {
    outline(view, budget, memory);
  } else {
    look(view, budget, memory);
    if (at_ == memory.visible_count) {
      ++view_;
      begin_view(views);
    }
  }
  return phase_ == Phase::done;
}

void AlignmentScoring::begin_view(std::span<const SceneView> views) noexcept {
  at_ = 0;
  indexing_.start();
  phase_ = view_ < views.size() ? Phase::index : Phase::done;
  if (phase_ == Phase::done) result_.median_m = median_m();
}

void AlignmentScoring::outline(const SceneView& view, StepBudget& budget,
                               const AlignmentScratch::View& memory) noexcept {
  const int pixels = view.camera.width * view.camera.height;
  const int end = budget.take_items(at_, pixels, k_outline_pixel_steps);
  add_outline(view, memory.z, memory.triangle, settings_.far_m, at_, end, result_.outline);
  for (; at_ < end; ++at_) {
    const auto pixel = static_cast<std::size_t>(at_);
    if (view.mask.empty() || view.mask[pixel] == 0 || !(view.depth_m[pixel] > 0)) continue;
    ++result_.mask_pixels;
    result_.mask_covered += memory.triangle[pixel] >= 0 ? 1 : 0;
  }
  if (at_ < pixels) return;
  at_ = 0;
  phase_ = Phase::look;
}

void AlignmentScoring::look(const SceneView& view, StepBudget& budget,
                            const AlignmentScratch::View& memory) noexcept {
  for (; at_ < memory.visible_count && !budget.spent(); ++at_) {
    budget.take(k_score_steps);
    score_point(view, memory.seen[static_cast<std::size_t>(at_)], memory.grid, budget);
  }
}

void AlignmentScoring::score_point(const SceneView& view, const VisiblePoint& seen,
                                   const PointGrid& grid, StepBudget& budget) noexcept {
  const auto pixel = static_cast<std::size_t>(seen.pixel);
  ++result_.rendered;
  const float z = view.depth_m[pixel];
  if (!(z > 0)) return;
  ++result_.measured;
  const double behind = static_cast<double>(z - seen.point.z());
  // A pixel outside the mask hides the model at any distance in front of it.
  const bool occluded_by_mask = !view.may_be_model(pixel) && behind < 0;
  if (occluded_by_mask || behind < -settings_.far_m) {
    ++result_.occluded;
    return;
  }
  if (behind > settings_.far_m) ++result_.free_space_violations;
  const Nearest nearest =
      grid.nearest(seen.point, static_cast<float>(k_distance_steps * k_distance_step_m), budget);
  const double distance = std::sqrt(static_cast<double>(nearest.square_m2));
  if (nearest.index >= 0 && distance <= settings_.inlier_m) ++result_.inliers;
  const double step = distance / k_distance_step_m;
  ++distances_[step < k_distance_steps ? static_cast<std::size_t>(step) : k_distance_steps];
  ++distance_count_;
}

double AlignmentScoring::median_m() const noexcept {
  int below = 0;
  for (int i = 0; i <= k_distance_steps; ++i) {
    below += distances_[static_cast<std::size_t>(i)];
    if (2 * below >= distance_count_) return (i + 0.5) * k_distance_step_m;
  }
  return 0;
}

AlignmentScore score_alignment(std::span<const SceneView> views, const Pose& T_world_base,
                               const ScoreSettings& settings, AlignmentScratch& scratch) noexcept {
  AlignmentScoring run;
  run.start(T_world_base, settings);
  for (StepBudget all; !run.step(views, all, scratch); all = StepBudget()) {
  }
  return run.result();
}

}  // namespace glint
