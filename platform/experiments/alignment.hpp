// Where the headset's world lies in the reference tracker's: the mean over many samples of one tool
// seen by both, deaf to single bad ones.
#pragma once

#include <span>

#include "kernels/geometry.hpp"

namespace glint {

// The tool's tip as both see it at one time.
struct PosePair {
  Pose T_reference_tip;
  Pose T_world_tip;
};

// T_reference_world. Rotation: mean of the samples' rotations (the quaternion with the least sum of
// squared chordal distances); translation: what carries one tip to the other, so that the lever arm
// to the world's origin does not matter. Samples beyond three times the median distance from the
// mean do not count. Identity for no samples. The relation is exact near the samples' place.
// Source: Markley, Cheng, Crassidis, Oshman 2007, Averaging quaternions, eq. (12) to (13).
[[nodiscard]] Pose align_worlds(std::span<const PosePair> samples);

// T_reference_world * T_world_tip against the reference.
struct PoseError {
  Vector3 position_m = Vector3::Zero();    // along the reference's axes
  Vector3 rotation_rad = Vector3::Zero();  // rotation vector about them
};
[[nodiscard]] PoseError pose_error(const Pose& T_reference_world, const PosePair& sample);

}  // namespace glint
