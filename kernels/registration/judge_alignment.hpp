// How well a model at a pose explains what is seen of it.
//
// What:     the model is rendered into each view. Of its pixels that were measured: hidden where
//           the scene is more than far_m in front, or in front at all where a mask says that it is
//           not the model; seen through where it is more than far_m behind; explained where a
//           scene point lies within inlier_m. Distances are those of the rendered points to the
//           nearest scene points. Beside the outline the scene falls away or goes on (outline.hpp).
// Cost:     a rendering, and a search a pixel.
// Worst:    the model fills the picture and is nowhere near the scene.
// Accuracy: the median to k_distance_step_m, and 40 mm at most: it is read off a histogram.
// Source:   the accept test of the project's own trials: share and seen through together.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "kernels/registration/align_model.hpp"
#include "kernels/registration/outline.hpp"

namespace glint {

struct JudgeSettings {
  double inlier_m = 0.020;
  double far_m = 0.040;
};
inline constexpr double k_distance_step_m = 5e-5;
inline constexpr int k_distance_steps = 800;
inline constexpr int k_outline_granted = 20;

struct Judgement {
  int rendered = 0;       // pixels of the model, in all views
  int measured = 0;       // of those, with a depth in the scene
  int hidden = 0;         // of the measured: something stands in front
  int inliers = 0;        // of the measured: a scene point within inlier_m
  int seen_through = 0;   // of the measured: the scene is more than far_m behind
  double median_m = 0;    // of the distances of all measured pixels that are not hidden
  int mask_pixels = 0;    // measured pixels of the masks ..
  int mask_covered = 0;   // .. and those that the model is rendered onto
  OutlineCounts outline;  // of all views
  Reason reason = Reason::none;

  [[nodiscard]] double inlier_share() const {
    return measured > hidden ? static_cast<double>(inliers) / (measured - hidden) : 0;
  }
  [[nodiscard]] double seen_through_share() const {
    return measured > 0 ? static_cast<double>(seen_through) / measured : 0;
  }
  // The same of what is not hidden: a pose gains nothing by hiding the rest of the model.
  [[nodiscard]] double unhidden_seen_through_share() const {
    return measured > hidden ? static_cast<double>(seen_through) / (measured - hidden) : 0;
  }
  [[nodiscard]] double mask_share() const {
    return mask_pixels > 0 ? static_cast<double>(mask_covered) / mask_pixels : 0;
  }
  // Of its outline: how much stands out from what is beside it. Of k_outline_granted pixels it is
  // granted: an outline that nobody saw speaks against nothing.
  [[nodiscard]] double outline_share() const {
    return static_cast<double>(outline.falls + k_outline_granted) /
           (outline.falls + outline.goes_on + k_outline_granted);
  }
  // How much of the model could be looked at.
  [[nodiscard]] double visible_share() const {
    return rendered > 0 ? static_cast<double>(measured - hidden) / rendered : 0;
  }
};

// In slices of at most the budget's steps and those of one look beyond them, step() after step()
// until it says true, with the same views and scratch each time.
inline constexpr int k_outline_pixel_steps = 60, k_judged_steps = 40;
class JudgeRun {
 public:
  void start(const Pose& T_world_base, const JudgeSettings& settings) noexcept GLINT_NONBLOCKING;
  [[nodiscard]] bool step(std::span<const SceneView> views, StepBudget& budget,
                          AlignmentScratch& scratch) noexcept GLINT_NONBLOCKING;
  // Complete when step() has said true.
  [[nodiscard]] const Judgement& result() const noexcept { return result_; }

 private:
  enum class Phase : std::uint8_t { begin, index, render, outline, look, done };
  void outline(const SceneView& view, StepBudget& budget,
               const AlignmentScratch::View& memory) noexcept;
  void look(const SceneView& view, StepBudget& budget,
            const AlignmentScratch::View& memory) noexcept;
  void look_at(const SceneView& view, const SeenPoint& seen, const PointGrid& grid,
               StepBudget& budget) noexcept;
  void begin_view(std::span<const SceneView> views) noexcept;
  [[nodiscard]] double median_m() const noexcept;

  Pose T_world_base_;
  JudgeSettings settings_;
  Judgement result_;
  SceneIndexing indexing_;
  ModelRendering rendering_;
  std::array<int, k_distance_steps + 1> distances_{};
  int distance_count_ = 0;
  Phase phase_ = Phase::done;
  std::size_t view_ = 0;
  int at_ = 0;
};

// All slices at once.
[[nodiscard]] Judgement judge_alignment(std::span<const SceneView> views, const Pose& T_world_base,
                                        const JudgeSettings& settings,
                                        AlignmentScratch& scratch) noexcept GLINT_NONBLOCKING;

}  // namespace glint
