// What the camera knows of one marker: the lens around it, and how sure its pixel and range are.
//
// What:     the marker's own variances, as its pixels tell, plus the declared ones, for what is
//           common to all pixels of a marker shows in none of them. Where no image says how the ray
//           turns, two directions at right angles to it, as far as a pixel of the declared focal
//           length turns it; without a focal length the range's sigma counts across the ray too.
// Cost:     some twenty multiplications, without an image two roots more.
// Worst:    a marker without an image.
// Accuracy: the sums are exact for errors that do not hang together. A lens's own pixel turns the
//           ray by less at the rim than the focal length says: only older recordings need that.
// Source:   variances of independent errors add.
#pragma once

#include <array>

#include "kernels/nonblocking.hpp"
#include "kernels/pose/local_rays.hpp"
#include "kernels/pose/marker.hpp"
#include "kernels/pose/weighted_marker.hpp"

namespace glint {

// The declared noise of one marker: 1 sigma along its ray and, from the pixel's, across it.
struct MarkerNoise {
  double range_sigma_m = 0.0015;
  double pixel_sigma_px = 0.1;           // an axis
  double focal_px = 0;                   // 0: as much across as along (points without an image)
  std::array<double, 2> principal_px{};  // the pixel of the lens's axis
};

// Nothing is surer than this, whatever is declared: an exact marker would have no weight.
inline constexpr double k_pixel_sigma_least_px = 0.01;
inline constexpr double k_range_sigma_least_m = 0.0001;

struct MarkerSight {
  LocalRays rays;
  MarkerVariance variance;
};

// range_m: to the marker's centre, positive. A sigma of 0 in the marker is not known: the declared
// one counts alone.
[[nodiscard]] MarkerSight sight_of(const Marker& marker, double range_m,
                                   const MarkerNoise& noise) noexcept GLINT_NONBLOCKING;

}  // namespace glint
