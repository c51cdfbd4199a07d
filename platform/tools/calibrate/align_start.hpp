// Closed-form initial guess for the alignment of two trackers: pairs of poses at a given offset,
// and the transforms between them.
#pragma once

#include <span>
#include <vector>

#include "platform/tools/calibrate/align.hpp"

namespace glint {

// Returns the poses whose time plus the offset is inside the reference, each with the reference
// samples around it.
[[nodiscard]] std::vector<AlignSample> paired(std::span<const TimedPose> poses,
                                              std::span<const TimedPose> reference, double offset_s,
                                              double gap_max_s);

struct AlignGuess {
  Pose x, y;
  double offset_s = 0;
};

// Both rotations from relative rotations between samples, then both translations by iteratively
// reweighted least squares.
[[nodiscard]] AlignGuess closed_form(std::span<const AlignSample> samples, double offset_s,
                                     LeverArm lever_arm);

// position_residual: the body's position by X pose Y, minus the reference's. rotation_residual: the
// rotation between the two.
[[nodiscard]] Vector3 position_residual(const AlignSample& sample, const AlignGuess& start);
[[nodiscard]] Vector3 rotation_residual(const AlignSample& sample, const AlignGuess& start);

}  // namespace glint
