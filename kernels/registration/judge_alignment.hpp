// Evaluation of an alignment: fractions of the visible model that are explained, hidden or seen
// through.
//
// What:     renders the model into each view. Of its pixels with a measured depth, counts: hidden
//           where the scene is more than far_m in front, or in front at all where a mask excludes
//           the pixel; seen through (free-space violation) where the scene is more than far_m
//           behind; explained where a scene point is within inlier_m. Distances are from rendered
//           points to the nearest scene points. outline.hpp counts depth discontinuities beside the
//           outline.
// Cost:     a rendering, and a search a pixel.
// Worst:    the model fills the image, far from any scene point.
// Accuracy: the median to k_distance_step_m, and 40 mm at most: it is read from a histogram.
// Source:   acceptance test of the project's own trials: inlier share and seen-through share
//           together.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "kernels/registration/align_model.hpp"
#include "kernels/registration/outline.hpp"

namespace glint {

struct ScoreSettings {
  double inlier_m = 0.020;
  double far_m = 0.040;
};
inline constexpr double k_distance_step_m = 5e-5;
inline constexpr int k_distance_steps = 800;
inline constexpr int k_outline_prior = 20;

struct AlignmentScore {
  int rendered = 0;               // pixels of the model, in all views
  int measured = 0;               // of those, with a depth in the scene
  int occluded = 0;               // of the measured: occluded by something nearer
  int inliers = 0;                // of the measured: a scene point within inlier_m
  int free_space_violations = 0;  // of the measured: the scene is more than far_m behind
  double median_m = 0;            // of the distances of all measured pixels that are not hidden
  int mask_pixels = 0;            // measured pixels of the masks ..
  int mask_covered = 0;           // .. and those that the rendered model covers
  OutlineCounts outline;          // of all views
  Reason reason = Reason::none;

  [[nodiscard]] double inlier_share() const {
    return measured > occluded ? static_cast<double>(inliers) / (measured - occluded) : 0;
  }
  [[nodiscard]] double seen_through_share() const {
    return measured > 0 ? static_cast<double>(free_space_violations) / measured : 0;
  }
  // The same relative to the pixels that are not hidden: a pose cannot improve by hiding the rest
  // of the model.
  [[nodiscard]] double unhidden_seen_through_share() const {
    return measured > occluded ? static_cast<double>(free_space_violations) / (measured - occluded)
                               : 0;
  }
  [[nodiscard]] double mask_share() const {
    return mask_pixels > 0 ? static_cast<double>(mask_covered) / mask_pixels : 0;
  }
  // Share of the outline's pixels beside which the scene falls away. Adds k_outline_prior such
  // pixels, so that an unobserved outline does not lower the share.
  [[nodiscard]] double outline_share() const {
    return static_cast<double>(outline.falls + k_outline_prior) /
           (outline.falls + outline.continues + k_outline_prior);
  }
  // Share of the model that could be observed.
  [[nodiscard]] double visible_share() const {
    return rendered > 0 ? static_cast<double>(measured - occluded) / rendered : 0;
  }
};

// The same in slices: call step() with the same views and scratch until it returns true. A slice
// exceeds the budget's steps by at most one search.
inline constexpr int k_outline_pixel_steps = 60, k_score_steps = 40;
class AlignmentScoring {
 public:
  void start(const Pose& T_world_base, const ScoreSettings& settings) noexcept GLINT_NONBLOCKING;
  [[nodiscard]] bool step(std::span<const SceneView> views, StepBudget& budget,
                          AlignmentScratch& scratch) noexcept GLINT_NONBLOCKING;
  // Complete once step() has returned true.
  [[nodiscard]] const AlignmentScore& result() const noexcept { return result_; }

 private:
  enum class Phase : std::uint8_t { begin, index, render, outline, look, done };
  void outline(const SceneView& view, StepBudget& budget,
               const AlignmentScratch::View& memory) noexcept;
  void look(const SceneView& view, StepBudget& budget,
            const AlignmentScratch::View& memory) noexcept;
  void score_point(const SceneView& view, const VisiblePoint& seen, const PointGrid& grid,
                   StepBudget& budget) noexcept;
  void begin_view(std::span<const SceneView> views) noexcept;
  [[nodiscard]] double median_m() const noexcept;

  Pose T_world_base_;
  ScoreSettings settings_;
  AlignmentScore result_;
  SceneIndexing indexing_;
  ModelRendering rendering_;
  std::array<int, k_distance_steps + 1> distances_{};
  int distance_count_ = 0;
  Phase phase_ = Phase::done;
  std::size_t view_ = 0;
  int at_ = 0;
};

// Runs all slices.
[[nodiscard]] AlignmentScore score_alignment(std::span<const SceneView> views,
                                             const Pose& T_world_base,
                                             const ScoreSettings& settings,
                                             AlignmentScratch& scratch) noexcept GLINT_NONBLOCKING;

}  // namespace glint
