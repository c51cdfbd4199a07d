// Covariance of an alignment with spatially correlated residuals: cluster-robust (sandwich)
// estimator over image patches.
//
// What:     an object that touches the model, a surface at a grazing angle or a lens causes
//           residuals that correlate with their neighbours'; a covariance of independent noise is
//           then too small. Here only patches of k_patch_pixels by k_patch_pixels are independent.
//           With A = sum J'J over all pairs and s = sum J'r over those of one patch, the covariance
//           is A^-1 (sum s s') A^-1, times patches / (patches - 6) for the fit's degrees of
//           freedom. For independent noise it equals that of align_model.hpp on average.
// Cost:     a rendering of each view and its projective pairs, once.
// Worst:    the model fills the images.
// Accuracy: relative error of a variance about sqrt(2 / patches). Errors that extend over many
//           patches, as from a wrong model, are not included.
// Source:   Liang and Zeger 1986, Biometrika 73(1), equation (8), with patches as clusters.
#pragma once

#include "kernels/registration/alignment_scratch.hpp"

namespace glint {

inline constexpr int k_patch_pixels = 16;
// Smallest number of patches with pairs.
inline constexpr int k_patches_min = 18;

// Covariance of translation and rotation about the base's origin, world axes, for a model that has
// converged at T_world_base; gate_m: the last gate of that alignment. Reason: not_prepared (the
// scratch is too small for the views), degenerate (too few patches, or an undetermined degree of
// freedom).
[[nodiscard]] Result<Matrix6> patch_covariance(
    std::span<const SceneView> views, const Pose& T_world_base, double gate_m,
    AlignmentScratch& scratch) noexcept GLINT_NONBLOCKING;

}  // namespace glint
