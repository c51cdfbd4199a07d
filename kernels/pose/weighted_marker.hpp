// One labelled marker as the weighted fit sees it: where it was measured, and how surely.
//
// What:     of a point p of the camera's frame, how many sigmas it lies beside what was measured:
//           two residuals across the ray, in the pixel's own noise, and one along it, in the
//           range's. Across the ray a pixel is the lens's linear map around the measured one, p /
//           (ray . p) = ray + along_x du + along_y dv, so that no lens is searched in the fit.
// Cost:     made once a marker: two products of vectors and a 2x2 Cholesky factor.
// Worst:    none is worse than another; noise that is not positive is refused.
// Accuracy: the lens's curvature over the residual, 1e-4 of it within a pixel.
// Source:   whitening by the inverse Cholesky factor, e.g. Foerstner and Wrobel 2016, section 4.2.
#pragma once

#include <span>

#include "kernels/geometry.hpp"
#include "kernels/nonblocking.hpp"
#include "kernels/pose/local_rays.hpp"
#include "kernels/result.hpp"

namespace glint {

// The noise of one marker's measurement. The pixel's is symmetric and positive.
struct MarkerVariance {
  double xx_px2 = 0.01, xy_px2 = 0, yy_px2 = 0.01;
  double range_m2 = 0.0015 * 0.0015;
};

struct WeightedMarker {
  Vector3 model_m = Vector3::Zero();  // tool frame
  Vector3 ray = Vector3::UnitZ();     // measured, unit, camera frame
  double range_m = 0;                 // of the marker's centre along it
  // (across . p) / (ray . p): a residual of one sigma an axis. At right angles to the ray.
  Vector3 across_first = Vector3::Zero(), across_second = Vector3::Zero();
  double per_range_sigma = 0;  // 1 / sigma of the range

  [[nodiscard]] Vector3 measured_m() const { return ray * range_m; }
};

// Of one or more, in the tool's frame.
[[nodiscard]] inline Vector3 mean_of(std::span<const WeightedMarker> markers) noexcept {
  Vector3 sum = Vector3::Zero();
  for (const WeightedMarker& marker : markers) sum += marker.model_m;
  return sum / static_cast<double>(markers.size());
}

// model_m: the marker in the tool's frame; rays: the lens around its measured pixel; range_m: to
// its centre, a sphere's radius behind the surface. Reason::out_of_range: a range or a variance
// that is not positive, a lens that does not turn with the pixel, anything not finite.
[[nodiscard]] Result<WeightedMarker> weigh_marker(
    const Vector3& model_m, const LocalRays& rays, double range_m,
    const MarkerVariance& variance) noexcept GLINT_NONBLOCKING;

}  // namespace glint
