// Nonlinear refinement of the alignment of two trackers.
#pragma once

#include <span>

#include "platform/tools/calibrate/align_start.hpp"

namespace glint {

enum class AlignLoss { none, cauchy };

struct AlignFit {
  AlignGuess found;
  // Of x (rotation vector, translation), y (the same) and the offset; y's entries are 0 without a
  // lever arm.
  Eigen::Matrix<double, 13, 13> covariance = Eigen::Matrix<double, 13, 13>::Zero();
  bool determined = false;  // the samples determine all unknowns
};

// The samples' sigmas set the relative weight of position and rotation.
[[nodiscard]] AlignFit refined_alignment(std::span<const AlignSample> samples,
                                         const AlignGuess& start, LeverArm lever_arm,
                                         AlignLoss loss);

}  // namespace glint
