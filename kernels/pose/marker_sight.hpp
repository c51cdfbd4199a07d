// Measurement model of one marker: the lens linearised at its pixel, and the variances of its pixel
// and range.
//
// What:     the marker's own variances, from its pixels, plus the declared ones, since errors
//           common to all pixels of a marker show in none of them. If no image gives the ray's
//           derivatives, two perpendicular directions replace them, of the length that a pixel of
//           the declared focal length gives. Without a focal length the range's sigma counts across
//           the ray too.
// Cost:     about twenty multiplications, without an image two roots more.
// Worst:    a marker without an image.
// Accuracy: the sums are exact for independent errors. At the rim one pixel of the real lens
//           rotates the ray by less than the focal length implies; only older recordings need this.
// Source:   variances of independent errors add.
#pragma once

#include <array>

#include "kernels/nonblocking.hpp"
#include "kernels/pose/local_rays.hpp"
#include "kernels/pose/marker.hpp"
#include "kernels/pose/weighted_marker.hpp"

namespace glint {

// Declared noise of one marker: 1 sigma along its ray and, from the pixel's, across it.
struct MarkerNoise {
  double range_sigma_m = 0.0015;
  double pixel_sigma_px = 0.1;           // per axis
  double focal_px = 0;                   // 0: the same across as along (points without an image)
  std::array<double, 2> principal_px{};  // principal point
};

// Lower limits of the sigmas, whatever is declared: an exact marker would have no weight.
inline constexpr double k_pixel_sigma_min_px = 0.01;
inline constexpr double k_range_sigma_min_m = 0.0001;

struct MarkerMeasurementModel {
  LocalRays rays;
  MarkerVariance variance;
};

// range_m: to the marker's centre, positive. A sigma of 0 in the marker is unknown: only the
// declared one counts.
[[nodiscard]] MarkerMeasurementModel measurement_model(
    const Marker& marker, double range_m, const MarkerNoise& noise) noexcept GLINT_NONBLOCKING;

}  // namespace glint
