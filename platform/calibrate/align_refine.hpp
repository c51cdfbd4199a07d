// The nonlinear part of aligning two trackers.
#pragma once

#include <span>

#include "platform/calibrate/align_start.hpp"

namespace glint {

enum class AlignLoss { none, cauchy };

struct AlignFit {
  AlignStart found;
  // Of x (rotation vector, translation), y (the same) and the offset; without a lever arm y's are
  // 0.
  Eigen::Matrix<double, 13, 13> covariance = Eigen::Matrix<double, 13, 13>::Zero();
  bool determined = false;  // whether the samples fix all of it
};

// The samples' sigmas weigh position against rotation.
[[nodiscard]] AlignFit refined_alignment(std::span<const AlignSample> samples,
                                         const AlignStart& start, LeverArm lever_arm,
                                         AlignLoss loss);

}  // namespace glint
