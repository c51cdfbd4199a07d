// Depth pixels used for a marker's range, and the position of each relative to the marker's centre.
//
// What:     inner: the pixels of the blob's inner disc, half its area; ring: the annulus from there
//           to just beyond the rim, without pixels that are mostly background. Only valid and
//           unsaturated pixels count.
// Cost:     the pixels of a square around the centroid; every second, third, .. pixel in both
//           directions if the square exceeds its budget. No branch depends on their values. Uses at
//           most the samples allowed, evenly spread over all that count.
// Worst:    a large blob with a saturated centre: both regions, the annulus with all samples.
// Accuracy: the same as with all pixels, except for the noise: a grid omits no side.
// Source:   a sphere's surface at s beside its centre is r - sqrt(r^2 - s^2) farther away.
#pragma once

#include <array>
#include <cstdint>

#include "kernels/image/blob.hpp"
#include "kernels/image/frame.hpp"
#include "kernels/nonblocking.hpp"
#include "kernels/pose/depth_settings.hpp"
#include "kernels/pose/local_rays.hpp"
#include "kernels/pose/robust_mean.hpp"

namespace glint {

inline constexpr int k_inner_samples_max = 49;
inline constexpr int k_annulus_samples_max = k_range_values_max;
inline constexpr int k_scan_radius_max_px = 40;
// The square around a disc of the largest inner radius: always read completely.
inline constexpr int k_inner_square_max_px = 9 * 9;
static_assert(k_range_pixels_per_blob > k_inner_square_max_px);
// Maximum square read for the annulus, even if others leave more: 400 of these pixels are in it.
inline constexpr int k_square_max_px = 32 * 32;

// One blob and the lens linearised at its centroid.
struct DepthView {
  const Frame& frame;
  const Blob& blob;
  const DepthSettings& depth;
  const LocalRays& rays;
};

// For each pixel that counts, its depth as the sensor states it, and its position. The first
// `count` entries are set, and one more to complete a pair.
struct DepthSamples {
  RangeValues range_m;        // along the pixel's ray or along the optical axis
  RangeValues radial_factor;  // factor to the radial range
  RangeValues offset_square;  // its ray's squared distance from the centre ray at range 1
  int count = 0;
  int tried = 0;   // pixels of the disc or annulus
  int usable = 0;  // of these with usable depth
  int pixels = 0;  // read
};

// radius_px: of the disc with the blob's area. Each writes at most samples_max samples;
// annulus_samples reads at most pixels_max pixels.
void inner_samples(const DepthView& view, double radius_px, int samples_max,
                   DepthSamples& out) noexcept GLINT_NONBLOCKING;
void annulus_samples(const DepthView& view, double radius_px, int samples_max, int pixels_max,
                     DepthSamples& out) noexcept GLINT_NONBLOCKING;

}  // namespace glint
