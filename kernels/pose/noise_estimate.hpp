// How noisy markers are, from the residuals of their fits: the declared noise is where it begins.
//
// What:     a residual v of variance t and leverage h has the expectation E v^2 = (1 - h) t, and t
//           is the marker's own variance plus the one declared for all (marker_sight.hpp). So the
//           latter is sum w (v^2 - (1 - h) own) / sum w (1 - h), for ranges and for pixels apart,
//           with w = (least t / t)^2. Old residuals lose weight as new ones come: about the newest
//           k_noise_memory of those free to deviate count. A residual beyond three sigma counts as
//           three.
// Cost:     for each fit the normal equations once more and their factor; three forward
//           substitutions a marker.
// Worst:    none is worse than another of as many markers.
// Accuracy: a variance within sqrt(2 / k_noise_memory) = 8 %, 1 sigma; 0.5 % too small by the three
//           sigmas. What several markers have in common (a tool's size, an offset of all ranges)
//           leaves no residual and is not in it.
// Source:   Foerstner 1979, "Ein Verfahren zur Schaetzung von Varianz- und Kovarianzkomponenten":
//           a variance for each group of observations by its residuals and their redundancy.
#pragma once

#include <span>

#include "kernels/geometry.hpp"
#include "kernels/nonblocking.hpp"
#include "kernels/pose/marker_sight.hpp"
#include "kernels/pose/weighted_marker.hpp"

namespace glint {

// Of ranges in m^2, of pixels in px^2.
struct ResidualSum {
  double squares = 0;   // beyond what the markers' own variances explain; may be negative
  double freedom = 0;   // how many residuals that is worth
  double declared = 0;  // of these, the declared noise's
};
struct MarkerResiduals {
  ResidualSum range, pixel;
};

// markers: as they were fitted to T_camera_tool; variances: what each was weighed with, in the same
// order; noise: the part of these that is declared for all. All sums are 0 where the markers do not
// fix the pose.
[[nodiscard]] MarkerResiduals residuals_of(std::span<const WeightedMarker> markers,
                                           std::span<const MarkerVariance> variances,
                                           const Pose& T_camera_tool,
                                           const MarkerNoise& noise) noexcept GLINT_NONBLOCKING;

inline constexpr double k_noise_memory = 300;  // residuals
// What the declared noise is worth beside the residuals.
inline constexpr double k_noise_declared_worth = 8;
// Beyond these a marker's residuals are no noise.
inline constexpr double k_range_sigma_most_m = 0.02;
inline constexpr double k_pixel_sigma_most_px = 1;

struct NoiseEstimate {
  MarkerResiduals sums;
  double range_sigma_m = 0, pixel_sigma_px = 0;  // by them
  bool known = false;                            // false: no residual yet
};

// Before there are residuals the variances may be larger than declared by this factor: published
// HoloLens-class range noise is 1.5 to 5 mm. That counts as so many residuals at most.
inline constexpr double k_noise_variance_open = 10;
inline constexpr double k_noise_open_worth = 3;

// By how much the variances may exceed the estimate: k_noise_variance_open before there are
// residuals, 1 after k_noise_memory.
[[nodiscard]] double variance_doubt(const NoiseEstimate& estimate,
                                    const MarkerNoise& declared) noexcept GLINT_NONBLOCKING;

// The declared noise until there are residuals.
[[nodiscard]] inline MarkerNoise noise_now(const NoiseEstimate& estimate,
                                           const MarkerNoise& declared) {
  if (!estimate.known) return declared;
  return {estimate.range_sigma_m, estimate.pixel_sigma_px, declared.focal_px,
          declared.principal_px};
}

// Adds the residuals of one fit, if it has any.
void add(const MarkerResiduals& residuals, const MarkerNoise& declared,
         NoiseEstimate& estimate) noexcept GLINT_NONBLOCKING;

}  // namespace glint
