// What errors that a whole picture shares do to an alignment: a covariance to add to its own.
//
// What:     depth that is off by a constant and by slopes along both sides of the picture, and a
//           camera whose rays are turned. With A = sum J'J over the projective pairs, and
//           B = sum J'b over the depth error b of one unit, the pose errs by A^-1 B; turned rays
//           turn the pose about the camera. All views share one camera's errors.
// Cost:     a rendering of each view and its projective pairs, once.
// Worst:    the model fills the pictures.
// Accuracy: first order. The magnitudes are declared, not estimated.
// Source:   consider covariance: Schmidt 1966; Bierman 1977, section VIII.2.
#pragma once

#include <span>

#include "kernels/registration/alignment_scratch.hpp"

namespace glint {

struct SharedErrors {
  double depth_sigma_m = 0.006;  // of the constant, and of each slope at the picture's edge
  double ray_sigma_rad = 0.003;  // a pixel of 320 across 60 deg
};

// Of shift and turn about the base's origin, world axes, as patch_covariance(). Reason:
// not_prepared (the scratch is too small for the views), degenerate (a direction is open).
[[nodiscard]] Result<Matrix6> shared_error_covariance(
    std::span<const SceneView> views, const Pose& T_world_base, double gate_m,
    const SharedErrors& errors, AlignmentScratch& scratch) noexcept GLINT_NONBLOCKING;

}  // namespace glint
