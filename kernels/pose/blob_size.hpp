// How far a marker's middle may be from its blob's, as the blob's size tells.
//
// What:     by how much the blob is larger or smaller than the marker's disc, as a strip along half
//           its rim. What all markers of a tool have of it is smear, or too little light; what one
//           has beyond is another disc that merged with it, what one lacks is hidden. The middle of
//           two equal discs d apart lies d / 2 beside either, and they cover 2 r d more than one: a
//           strip of 2 d / pi. Where half a disc is gone the rest's middle is 0.85 of the missing
//           strip away, where little is gone a little more, where much is gone less: 0.8.
// Cost:     a root and some twenty operations.
// Worst:    none is worse than another.
// Accuracy: drawn discs of 2 to 5 px (`BlobSize.*`): merged with an equal one their middle is off
//           by 1.35 px an axis, rms, where 1.38 are stated, half hidden by 1.38 where 1.38 are. A
//           strip below k_strip_noise_px, up to half a pixel of the middle, is not noticed.
// Source:   the area of two overlapping discs, first order in their distance; the middle of a
//           disc's segment, e.g. Bronshtein and Semendyayev, Handbook of Mathematics, section 3.3.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kernels/nonblocking.hpp"
#include "kernels/pose/marker_sight.hpp"
#include "kernels/pose/tool.hpp"

namespace glint {

// The optics and a threshold below half the brightness widen a disc by so much all round.
inline constexpr double k_rim_px = 0.3;
// Of a strip, what pixels that just count or just do not may make.
inline constexpr double k_strip_noise_px = 0.7;
// How far a strip moves the middle.
inline constexpr double k_moved_by_merging = 0.25 * std::numbers::pi, k_moved_by_hiding = 0.8;
// The range of a merged blob may be the other's, as far as a correspondence takes it for the
// marker's: evenly within 8 sigmas.
inline constexpr double k_merged_range_growth = 8.0 * 8.0 / 3;

// The strip's width in pixels, negative where some of the disc is not seen. 0 where there is no
// image, or only a part of one; never negative for a flat marker, which a tilt narrows.
[[nodiscard]] inline double strip_px(const Marker& marker, const LocalRays& rays, const Tool& tool,
                                     double range_m) noexcept GLINT_NONBLOCKING {
  const double steradian = rays.steradian_per_pixel();
  const bool whole = marker.area_px > 0 && (marker.flags & k_marker_touches_edge) == 0;
  const double radius_px = tool.marker_radius_m / (range_m * std::sqrt(steradian));
  if (!whole || !(radius_px > 0) || !std::isfinite(radius_px)) return 0;
  const double rim_px = radius_px + k_rim_px;
  const double disc_px2 = std::numbers::pi * rim_px * rim_px;
  const double strip = (marker.area_px - disc_px2) / (std::numbers::pi * radius_px);
  return tool.shape == MarkerShape::sphere ? strip : std::max(strip, 0.0);
}

// What a tool's seen markers have in common.
struct CommonStrip {
  double least_px = 1e9, most_px = -1e9;
  void add(double strip_px) noexcept {
    least_px = std::min(least_px, strip_px);
    most_px = std::max(most_px, strip_px);
  }
  // The strip that is this marker's alone.
  [[nodiscard]] double beyond(double strip_px) const noexcept {
    return strip_px - std::clamp(strip_px, std::min(most_px, 0.0), std::max(least_px, 0.0));
  }
};

[[nodiscard]] constexpr bool is_merged(double own_strip_px) {
  return own_strip_px > k_strip_noise_px;
}
[[nodiscard]] constexpr bool is_partly_hidden(double own_strip_px) {
  return own_strip_px < -k_strip_noise_px;
}

// Adds what the marker's own strip says.
inline void widen(MarkerVariance& variance, double own_strip_px) noexcept GLINT_NONBLOCKING {
  const bool merged = is_merged(own_strip_px);
  if (!merged && !is_partly_hidden(own_strip_px)) return;
  const double moved_px = own_strip_px * (merged ? k_moved_by_merging : k_moved_by_hiding);
  variance.xx_px2 += 0.5 * moved_px * moved_px;
  variance.yy_px2 += 0.5 * moved_px * moved_px;
  if (merged) variance.range_m2 *= k_merged_range_growth;
}

}  // namespace glint
