#include "kernels/pose/marker_sight.hpp"

#include <algorithm>

namespace glint {
namespace {

double variance_of(double own_sigma, double declared_sigma, double least) {
  return std::max(own_sigma * own_sigma + declared_sigma * declared_sigma, least * least);
}

// Two perpendicular derivatives of the ray, of length `turn` per unit.
LocalRays synthetic_rays(const Marker& marker, double turn) {
  const Vector3 first = marker.ray.unitOrthogonal();
  return {marker.centroid_px, marker.ray, turn * first, turn * marker.ray.cross(first),
          Vector3(marker.ray.x(), marker.ray.y(), 0)};
}

}  // namespace

MarkerMeasurementModel measurement_model(const Marker& marker, double range_m,
                                         const MarkerNoise& noise) noexcept {
  MarkerMeasurementModel sight;
  sight.rays = {marker.centroid_px, marker.ray, marker.along_x, marker.along_y};
  sight.rays.set_outward({noise.principal_px[0], noise.principal_px[1]});
  MarkerVariance& variance = sight.variance;
  variance.range_m2 = variance_of(marker.range_sigma_m, noise.range_sigma_m, k_range_sigma_min_m);
  variance.xy_px2 = 0;
  const bool has_image = sight.rays.steradian_per_pixel() > 0;
  if (!has_image && !(noise.focal_px > 0)) {
    // The unit is a metre at the marker's range instead of a pixel.
    sight.rays = synthetic_rays(marker, 1 / range_m);
    variance.xx_px2 = variance.yy_px2 = variance.range_m2;
    return sight;
  }
  if (!has_image) sight.rays = synthetic_rays(marker, 1 / noise.focal_px);
  variance.xx_px2 = variance_of(marker.sigma_px[0], noise.pixel_sigma_px, k_pixel_sigma_min_px);
  variance.yy_px2 = variance_of(marker.sigma_px[1], noise.pixel_sigma_px, k_pixel_sigma_min_px);
  return sight;
}

}  // namespace glint
