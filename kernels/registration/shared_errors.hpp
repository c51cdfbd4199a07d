// Consider covariance of an alignment for systematic errors common to a whole image; add it to the
// alignment's own covariance.
//
// What:     depth errors (a constant and slopes along both sides of the image), and a rotation of
//           the camera's rays. With A = sum J'J over the projective pairs, and B = sum J'b over the
//           depth error b of one unit, the pose error is A^-1 B; rotated rays rotate the pose about
//           the camera. All views share the errors of one camera.
// Cost:     a rendering of each view and its projective pairs, once.
// Worst:    the model fills the images.
// Accuracy: first order. The magnitudes are declared, not estimated.
// Source:   consider covariance: Schmidt 1966; Bierman 1977, section VIII.2.
#pragma once

#include <span>

#include "kernels/registration/alignment_scratch.hpp"

namespace glint {

struct SystematicErrors {
  double depth_sigma_m = 0.006;  // of the constant, and of each slope at the image's edge
  double ray_sigma_rad = 0.003;  // one pixel of 320 across 60 deg
};

// Covariance of translation and rotation about the base's origin, world axes, as
// patch_covariance(). Reason: not_prepared (the scratch is too small for the views), degenerate (an
// undetermined degree of freedom).
[[nodiscard]] Result<Matrix6> consider_covariance(
    std::span<const SceneView> views, const Pose& T_world_base, double gate_m,
    const SystematicErrors& errors, AlignmentScratch& scratch) noexcept GLINT_NONBLOCKING;

}  // namespace glint
