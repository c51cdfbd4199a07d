// Whitened measurement of one labelled marker for the weighted fit: its pixel and range, with
// weights.
//
// What:     for a point p of the camera's frame, its deviation from the measurement in standard
//           deviations: two residuals across the ray, in the pixel's own noise, and one along it,
//           in the range's. Across the ray the lens is linearised at the measured pixel, p / (ray .
//           p) = ray + along_x du + along_y dv, so that the fit needs no search in the lens.
// Cost:     once per marker: two products of vectors and a 2x2 Cholesky factor.
// Worst:    data independent; noise that is not positive is rejected.
// Accuracy: the lens's curvature over the residual, 1e-4 of it within a pixel.
// Source:   whitening by the inverse Cholesky factor, e.g. Foerstner and Wrobel 2016, section 4.2.
#pragma once

#include <span>

#include "kernels/geometry.hpp"
#include "kernels/nonblocking.hpp"
#include "kernels/pose/local_rays.hpp"
#include "kernels/result.hpp"

namespace glint {

// Noise of one marker's measurement. The pixel's covariance is symmetric and positive definite.
struct MarkerVariance {
  double xx_px2 = 0.01, xy_px2 = 0, yy_px2 = 0.01;
  double range_m2 = 0.0015 * 0.0015;
};

struct WeightedMarker {
  Vector3 model_m = Vector3::Zero();  // tool frame
  Vector3 ray = Vector3::UnitZ();     // measured, unit, camera frame
  double range_m = 0;                 // of the marker's centre along it
  // (across . p) / (ray . p) is a residual in standard deviations. Perpendicular to the ray.
  Vector3 across_first = Vector3::Zero(), across_second = Vector3::Zero();
  double per_range_sigma = 0;  // 1 / sigma of the range

  [[nodiscard]] Vector3 measured_m() const { return ray * range_m; }
};

// Mean of at least one marker, tool frame.
[[nodiscard]] inline Vector3 mean_of(std::span<const WeightedMarker> markers) noexcept {
  Vector3 sum = Vector3::Zero();
  for (const WeightedMarker& marker : markers) sum += marker.model_m;
  return sum / static_cast<double>(markers.size());
}

// model_m: the marker in the tool's frame; rays: the lens linearised at its measured pixel;
// range_m: to its centre, a sphere's radius behind the surface. Returns Reason::out_of_range if a
// range or a variance is not positive, the ray does not change with the pixel, or a value is not
// finite.
[[nodiscard]] Result<WeightedMarker> whiten_marker(
    const Vector3& model_m, const LocalRays& rays, double range_m,
    const MarkerVariance& variance) noexcept GLINT_NONBLOCKING;

}  // namespace glint
