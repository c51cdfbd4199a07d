// Noise of marker ranges and pixels, estimated from the residuals of their fits (variance component
// estimation); the declared noise is the initial value.
//
// What:     a residual v of variance t and leverage h has the expectation E v^2 = (1 - h) t. t is
//           the marker's own variance plus the one declared for all (marker_sight.hpp). So the
//           latter is sum w (v^2 - (1 - h) own) / sum w (1 - h), for ranges and for pixels
//           separately, with w = (declared part of t / t)^2, since the variance of v^2 grows with
//           t^2: markers whose own variance is large, and perhaps overstated, count little. The
//           weight of old residuals decays: about the newest k_noise_memory degrees of freedom
//           count. A residual beyond three sigma is clipped to three.
// Cost:     for each fit the normal equations once more and their factor; three forward
//           substitutions per marker.
// Worst:    data independent for a given number of markers.
// Accuracy: a variance within sqrt(2 / k_noise_memory) = 8 %, 1 sigma; 0.5 % too small by the
//           clipping. Systematic errors common to several markers (a tool's size, an offset of all
//           ranges) leave no residual and are not included.
// Source:   Foerstner 1979, "Ein Verfahren zur Schaetzung von Varianz- und Kovarianzkomponenten": a
//           variance for each group of observations by its residuals and their redundancy.
#pragma once

#include <span>

#include "kernels/geometry.hpp"
#include "kernels/nonblocking.hpp"
#include "kernels/pose/marker_sight.hpp"
#include "kernels/pose/weighted_marker.hpp"

namespace glint {

// Units: of ranges m^2, of pixels px^2.
struct ResidualSum {
  double squares = 0;     // in excess of the markers' own variances; may be negative
  double redundancy = 0;  // degrees of freedom of these residuals
  double declared = 0;    // part of the redundancy from the declared noise
};
struct MarkerResiduals {
  ResidualSum range, pixel;
};

// markers: as fitted to T_camera_tool; variances: those of their weights, in the same order; noise:
// the part of these that is declared for all. All sums are 0 if the markers do not determine the
// pose.
[[nodiscard]] MarkerResiduals residuals_of(std::span<const WeightedMarker> markers,
                                           std::span<const MarkerVariance> variances,
                                           const Pose& T_camera_tool,
                                           const MarkerNoise& noise) noexcept GLINT_NONBLOCKING;

inline constexpr double k_noise_memory = 300;  // degrees of freedom
// Weight of the declared noise, in degrees of freedom.
inline constexpr double k_noise_declared_weight = 8;
// Upper limits of the sigmas: larger residuals are not noise.
inline constexpr double k_range_sigma_max_m = 0.02;
inline constexpr double k_pixel_sigma_max_px = 1;

struct NoiseEstimate {
  MarkerResiduals sums;
  double range_sigma_m = 0, pixel_sigma_px = 0;  // from the sums
  bool has_residuals = false;                    // false: no residual yet
};

// Before the first residuals the variances may exceed the declared ones by this factor: published
// HoloLens-class range noise is 1.5 to 5 mm. The larger value has a weight of at most
// k_noise_inflated_weight degrees of freedom.
inline constexpr double k_noise_variance_inflation = 10;
inline constexpr double k_noise_inflated_weight = 3;

// Returns the factor by which the variances may exceed the estimate: k_noise_variance_inflation
// before the first residuals, about 1 after k_noise_memory.
[[nodiscard]] double variance_inflation(const NoiseEstimate& estimate,
                                        const MarkerNoise& declared) noexcept GLINT_NONBLOCKING;

// Returns the estimate, or the declared noise before the first residuals.
[[nodiscard]] inline MarkerNoise noise_now(const NoiseEstimate& estimate,
                                           const MarkerNoise& declared) {
  if (!estimate.has_residuals) return declared;
  return {estimate.range_sigma_m, estimate.pixel_sigma_px, declared.focal_px,
          declared.principal_px};
}

// Adds the residuals of one fit, if it has any.
void add(const MarkerResiduals& residuals, const MarkerNoise& declared,
         NoiseEstimate& estimate) noexcept GLINT_NONBLOCKING;

}  // namespace glint
