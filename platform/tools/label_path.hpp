// Which labeling holds in each frame of a recording: the most likely path through all of them.
//
// What:     a labeling costs its squared residuals in sigmas, and as much as chi-square would
//           refuse for each marker fewer than the frame's best has. From frame to frame a path
//           costs nothing where a hand can have moved the tool so, else k_jump. A frame's margin is
//           by how much the best path through another pose costs more than the best path of all:
//           twice the logarithm of their likelihoods' ratio.
// Cost:     the square of k_labelings_max for each frame, forward and backward.
// Worst:    a recording of markers that fit in k_labelings_max ways in each frame.
// Accuracy: of the paths there are the best. Errors of the tool file and of the camera system
//           repeat in each frame, so that a longer segment counts as (sigma / repeated error)^2
//           frames.
// Source:   Viterbi 1967; margins by the same pass backwards (max-marginals of a chain).
#pragma once

#include <span>
#include <vector>

#include "kernels/pose/labeling.hpp"
#include "kernels/pose/tool.hpp"
#include "kernels/units.hpp"

namespace glint {

struct PathSettings {
  double sigma_m = 0.0005;            // of a marker's coordinate
  double repeated_error_m = 0.00004;  // of it, what repeats in each frame at least
  double speed_max_m_s = 5;           // of a hand-held tool's middle
  double turn_max_rad_s = 20;         // of its rotation: half a turn takes 0.16 s
};

// Of what is wrong once in fifty times: 2 ln 49.
inline constexpr double k_margin_min = 7.8;

// All labelings of one frame.
struct LabeledFrame {
  Time time;
  std::vector<Labeling> labelings;  // T_camera_tool in the recording's own frame
};

struct PathChoice {
  int chosen = -1;    // of the frame's labelings; -1: it has none
  double margin = 0;  // in units of chi-square; infinite where no other pose is in question
  [[nodiscard]] bool ambiguous() const { return chosen >= 0 && !(margin >= k_margin_min); }
};

// One choice a frame. Poses are other poses where they count as gross errors of each other. A
// labeling that neither of its neighbours in time leads to has no margin.
[[nodiscard]] std::vector<PathChoice> choose_path(std::span<const LabeledFrame> frames,
                                                  const Tool& tool, const PathSettings& settings);

}  // namespace glint
