// Labeling of a recording by dynamic programming (Viterbi): most likely path of labelings, with
// margins.
//
// What:     a labeling costs its squared residuals in sigmas, plus the chi-square limit for each
//           marker fewer than the frame's best labeling has. A step between frames costs nothing if
//           a hand can make the motion, else k_jump. A frame's margin is the extra cost of the best
//           path through another pose: twice the log likelihood ratio.
// Cost:     the square of k_labelings_max for each frame, forward and backward.
// Worst:    markers that fit in k_labelings_max ways in every frame.
// Accuracy: optimal among the paths. Errors of tool file and camera system repeat in each frame; a
//           segment therefore counts as at most (sigma / repeated error)^2 frames.
// Source:   Viterbi 1967; margins by the backward pass (max-marginals of a chain).
#pragma once

#include <span>
#include <vector>

#include "kernels/pose/labeling.hpp"
#include "kernels/pose/tool.hpp"
#include "kernels/units.hpp"

namespace glint {

struct PathSettings {
  double sigma_m = 0.0005;              // of a marker's coordinate
  double repeated_error_m = 0.00004;    // minimum part of it that repeats in each frame
  double speed_max_m_s = 5;             // of the centroid of a hand-held tool
  double angular_speed_max_rad_s = 20;  // of its rotation: 180 degrees take 0.16 s
};

// Limit for an error probability of 1 in 50: 2 ln 49.
inline constexpr double k_margin_min = 7.8;

// All labelings of one frame.
struct LabeledFrame {
  Time time;
  std::vector<Labeling> labelings;  // T_camera_tool in the recording's own frame
};

struct PathChoice {
  int chosen = -1;    // index in the frame's labelings; -1: none
  double margin = 0;  // in units of chi-square; infinite without another pose
  [[nodiscard]] bool ambiguous() const { return chosen >= 0 && !(margin >= k_margin_min); }
};

// Returns one choice per frame. Poses differ if they count as gross errors of each other. A
// labeling that neither neighbour in time can lead to has margin 0.
[[nodiscard]] std::vector<PathChoice> choose_path(std::span<const LabeledFrame> frames,
                                                  const Tool& tool, const PathSettings& settings);

}  // namespace glint
