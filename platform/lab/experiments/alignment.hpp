// Alignment of the headset's world with the reference tracker's frame, from many samples of one
// tool seen by both: mean rotation and translation with outlier rejection.
#pragma once

#include <span>

#include "kernels/geometry.hpp"

namespace glint {

// Pose of the tool's tip at one time, from both systems.
struct PosePair {
  Pose T_reference_tip;
  Pose T_world_tip;
};

// Returns T_reference_world. Rotation: mean of the samples' rotations (the quaternion with the
// least sum of squared chordal distances). Translation: mean offset of the tips after rotation, so
// that the lever arm to the world's origin has no effect. Rejects samples beyond three times the
// median distance from the mean. Returns identity for no samples. Exact near the samples'
// positions.
// Source:   Markley, Cheng, Crassidis, Oshman 2007, Averaging quaternions, eq. (12) to (13).
[[nodiscard]] Pose align_worlds(std::span<const PosePair> samples);

// Error of T_reference_world * T_world_tip against T_reference_tip.
struct PoseError {
  Vector3 position_m = Vector3::Zero();    // along the reference's axes
  Vector3 rotation_rad = Vector3::Zero();  // rotation vector about the reference's axes
};
[[nodiscard]] PoseError pose_error(const Pose& T_reference_world, const PosePair& sample);

}  // namespace glint
