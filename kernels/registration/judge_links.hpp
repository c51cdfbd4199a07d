// How well each link of a robot at a pose is explained by what is seen.
//
// What:     the model is rendered into each view, and its pixels are counted by link: looked at
//           (measured, and not hidden as in judge_alignment.hpp), explained where a scene point
//           lies within inlier_m, seen through where the scene is more than far_m behind.
// Cost:     a rendering, a grid of the picture, and a search a pixel.
// Worst:    the model fills the picture and is nowhere near the scene.
// Accuracy: counts.
// Source:   wrong joint positions leave single links unexplained where the base still fits.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "kernels/registration/judge_alignment.hpp"
#include "kernels/robot/joint_tree.hpp"

namespace glint {

struct LinkCounts {
  int looked_at = 0, explained = 0, seen_through = 0;  // pixels
};

struct LinkJudgement {
  std::array<LinkCounts, k_robot_links_max> links;
  Reason reason = Reason::none;  // not_prepared: the scratch is too small for the views
};

// link_numbers: for each view the link of each triangle, or point of a model that is points. A
// view without numbers adds nothing, nor does a number that is no link.
[[nodiscard]] LinkJudgement judge_links(
    std::span<const SceneView> views, std::span<const std::span<const std::uint16_t>> link_numbers,
    const Pose& T_world_base, const JudgeSettings& settings,
    AlignmentScratch& scratch) noexcept GLINT_NONBLOCKING;

}  // namespace glint
