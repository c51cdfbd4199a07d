// The depth pixels that tell a marker's range, and what each says about its front point.
//
// What:     inner: the pixels in the blob's middle half; ring: those from there to just beyond the
//           rim that are not mostly background. Only valid and unsaturated ones count.
// Cost:     the pixels of a square around the centroid, every second, third .. of them in both
//           directions where the square holds more than it may, without a branch on what they hold;
//           at most the samples allowed, evenly of all that count.
// Worst:    a large blob whose middle is saturated: both, the ring with all samples.
// Accuracy: the same as all pixels' but for the noise: a grid leaves no side out.
// Source:   a sphere's surface seen s beside its middle lies r - sqrt(r^2 - s^2) further away.
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
inline constexpr int k_ring_samples_max = k_range_values_max;
inline constexpr int k_scan_radius_max_px = 40;
// The square around a disc of the largest inner radius: it is always looked at as a whole.
inline constexpr int k_inner_square_max_px = 9 * 9;
static_assert(k_range_pixels_a_blob > k_inner_square_max_px);
// What the ring is sought in, also where others leave more: 400 of so many lie in it.
inline constexpr int k_square_max_px = 32 * 32;

// One blob and the lens around its middle.
struct DepthView {
  const Frame& frame;
  const Blob& blob;
  const DepthSettings& depth;
  const LocalRays& rays;
};

// Of each pixel that counts its depth as the sensor states it, and where the pixel lies. The first
// `count` are set, and one more where pairs need it.
struct DepthSamples {
  RangeValues range_m;        // along the pixel's ray or along the optical axis
  RangeValues radial_factor;  // makes it radial
  RangeValues beside_square;  // its ray's distance from the middle one at range 1, squared
  int count = 0;
  int tried = 0;   // pixels of the disc or ring
  int usable = 0;  // of these with a depth of use
  int pixels = 0;  // looked at
};

// radius_px: of the disc that has the blob's area. At most `most_samples`.
void inner_samples(const DepthView& view, double radius_px, int most_samples,
                   DepthSamples& out) noexcept GLINT_NONBLOCKING;
void ring_samples(const DepthView& view, double radius_px, int most_samples, int most_pixels,
                  DepthSamples& out) noexcept GLINT_NONBLOCKING;

}  // namespace glint
