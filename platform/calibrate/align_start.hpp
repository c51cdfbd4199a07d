// The closed part of aligning two trackers: pairs of poses at an offset, and the transforms that
// carry one into the other.
#pragma once

#include <span>
#include <vector>

#include "platform/calibrate/align.hpp"

namespace glint {

// The poses whose time, with the offset, lies within the reference, each with its piece of it.
[[nodiscard]] std::vector<AlignSample> paired(std::span<const StampedPose> poses,
                                              std::span<const StampedPose> reference,
                                              double offset_s, double gap_max_s);

struct AlignStart {
  Pose x, y;
  double offset_s = 0;
};

// Rotations of both from the turns between samples, then translations by reweighted least squares.
[[nodiscard]] AlignStart closed_form(std::span<const AlignSample> samples, double offset_s,
                                     LeverArm lever_arm);

// The body's place by X pose Y, less the reference's; and the rotation between both.
[[nodiscard]] Vector3 align_miss(const AlignSample& sample, const AlignStart& start);
[[nodiscard]] Vector3 align_turn(const AlignSample& sample, const AlignStart& start);

}  // namespace glint
