// Evaluation of an alignment per robot link: pixels explained, observed and seen through.
//
// What:     renders the model into each view and counts its pixels by link: observed (measured, and
//           not hidden as in judge_alignment.hpp), explained where a scene point is within
//           inlier_m, seen through where the scene is more than far_m behind.
// Cost:     a rendering, a grid of the image, and a search a pixel.
// Worst:    the model fills the image, far from any scene point.
// Accuracy: counts.
// Source:   wrong joint positions leave single links unexplained although the base fits.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "kernels/registration/judge_alignment.hpp"
#include "kernels/robot/joint_tree.hpp"

namespace glint {

struct LinkCounts {
  int looked_at = 0, explained = 0, free_space_violations = 0;  // pixels
};

struct LinkScores {
  std::array<LinkCounts, k_robot_links_max> links;
  Reason reason = Reason::none;  // not_prepared: the scratch is too small for the views
};

// link_numbers: per view the link of each triangle, or of each point of a point cloud model.
// Ignores a view without numbers, and a number that is no link.
[[nodiscard]] LinkScores score_links(std::span<const SceneView> views,
                                     std::span<const std::span<const std::uint16_t>> link_numbers,
                                     const Pose& T_world_base, const ScoreSettings& settings,
                                     AlignmentScratch& scratch) noexcept GLINT_NONBLOCKING;

}  // namespace glint
