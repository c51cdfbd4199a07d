// Centroid error of a merged or partially occluded marker, from the area of its blob.
//
// What:     the blob's excess or lack of area against the marker's disc, as a rim offset along half
//           its rim. The part common to all markers of a tool is motion blur or low signal. An
//           individual excess is a second, merged disc; an individual lack is occlusion. The centre
//           of two equal discs d apart is d / 2 from either, and they cover 2 r d more than one: a
//           rim offset of 2 d / pi. Where half a disc is hidden, the centroid of the rest is 0.85
//           of the missing rim offset away; a little more if little is hidden, less if much is:
//           0.8.
// Cost:     a square root and about twenty operations.
// Worst:    data independent.
// Accuracy: drawn discs of 2 to 5 px (`BlobSize.*`), rms centroid error per axis: 1.35 px where
//           1.38 are stated for a disc merged with an equal one, 1.38 px where 1.38 are stated for
//           a half-hidden one. A rim offset below k_rim_offset_noise_px, up to half a pixel of the
//           centroid, is not detected.
// Source:   the area of two overlapping discs, first order in their distance; the centroid of a
//           disc's segment, e.g. Bronshtein and Semendyayev, Handbook of Mathematics, section 3.3.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kernels/nonblocking.hpp"
#include "kernels/pose/marker_sight.hpp"
#include "kernels/pose/tool.hpp"

namespace glint {

// Rim offset on all sides that the optics and a threshold below half the brightness cause.
inline constexpr double k_rim_px = 0.3;
// Rim offset that pixels near the threshold may cause.
inline constexpr double k_rim_offset_noise_px = 0.7;
// Offset of the centroid relative to the rim offset.
inline constexpr double k_merging_gain = 0.25 * std::numbers::pi, k_occlusion_gain = 0.8;
// Variance factor of a merged blob's range. The range may be the other marker's, within the 8 sigma
// that the correspondence accepts: uniform distribution.
inline constexpr double k_merged_range_inflation = 8.0 * 8.0 / 3;

// Returns the rim offset in pixels, negative if part of the disc is hidden. Returns 0 without an
// image or if the blob touches the border. Never negative for a flat marker, which a tilt narrows.
[[nodiscard]] inline double rim_offset_px(const Marker& marker, const LocalRays& rays,
                                          const Tool& tool,
                                          double range_m) noexcept GLINT_NONBLOCKING {
  const double steradian = rays.steradian_per_pixel();
  const bool is_complete = marker.area_px > 0 && (marker.flags & k_marker_touches_edge) == 0;
  const double radius_px = tool.marker_radius_m / (range_m * std::sqrt(steradian));
  if (!is_complete || !(radius_px > 0) || !std::isfinite(radius_px)) return 0;
  const double rim_px = radius_px + k_rim_px;
  const double disc_px2 = std::numbers::pi * rim_px * rim_px;
  const double strip = (marker.area_px - disc_px2) / (std::numbers::pi * radius_px);
  return tool.shape == MarkerShape::sphere ? strip : std::max(strip, 0.0);
}

// Rim offset common to a tool's visible markers.
struct CommonRimOffset {
  double min_px = 1e9, max_px = -1e9;
  void add(double rim_offset_px) noexcept {
    min_px = std::min(min_px, rim_offset_px);
    max_px = std::max(max_px, rim_offset_px);
  }
  // Rim offset of this marker beyond the common one.
  [[nodiscard]] double beyond(double rim_offset_px) const noexcept {
    return rim_offset_px - std::clamp(rim_offset_px, std::min(max_px, 0.0), std::max(min_px, 0.0));
  }
};

[[nodiscard]] constexpr bool is_merged(double own_rim_offset_px) {
  return own_rim_offset_px > k_rim_offset_noise_px;
}
[[nodiscard]] constexpr bool is_partially_occluded(double own_rim_offset_px) {
  return own_rim_offset_px < -k_rim_offset_noise_px;
}

// Inflates the variance by the marker's own rim offset.
inline void inflate(MarkerVariance& variance, double own_rim_offset_px) noexcept GLINT_NONBLOCKING {
  const bool merged = is_merged(own_rim_offset_px);
  if (!merged && !is_partially_occluded(own_rim_offset_px)) return;
  const double moved_px = own_rim_offset_px * (merged ? k_merging_gain : k_occlusion_gain);
  variance.xx_px2 += 0.5 * moved_px * moved_px;
  variance.yy_px2 += 0.5 * moved_px * moved_px;
  if (merged) variance.range_m2 *= k_merged_range_inflation;
}

}  // namespace glint
