// How sure an alignment is where neighbouring pixels err alike.
//
// What:     something that touches the model, a surface seen at a grazing angle, a lens: a residual
//           errs as its neighbours do, and a covariance of independent noise says too little. Here
//           only patches of k_patch_pixels by as many are taken as independent. With A = sum J'J
//           over all pairs and s = sum J'r over those of one patch, the covariance is
//           A^-1 (sum s s') A^-1, times patches / (patches - 6) for what the fit took. Where noise
//           is independent this is that of align_model.hpp on average.
// Cost:     a rendering of each view and its projective pairs, once.
// Worst:    the model fills the pictures.
// Accuracy: a variance to about sqrt(2 / patches) of itself; errors that reach over many patches,
//           as of a wrong model, are not in it.
// Source:   Liang and Zeger 1986, Biometrika 73(1), equation (8), with patches as clusters.
#pragma once

#include "kernels/registration/alignment_scratch.hpp"

namespace glint {

inline constexpr int k_patch_pixels = 16;
// With fewer that have pairs nothing is said.
inline constexpr int k_patches_least = 18;

// Of shift and turn about the base's origin, world axes, for a model that rests at T_world_base;
// gate_m as the last one that it was aligned with. Reason: not_prepared (the scratch is too small
// for the views), degenerate (too few patches, or they leave a direction open).
[[nodiscard]] Result<Matrix6> patch_covariance(
    std::span<const SceneView> views, const Pose& T_world_base, double gate_m,
    AlignmentScratch& scratch) noexcept GLINT_NONBLOCKING;

}  // namespace glint
