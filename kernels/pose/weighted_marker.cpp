#include "kernels/pose/weighted_marker.hpp"

#include <cmath>

namespace glint {

Result<WeightedMarker> whiten_marker(const Vector3& model_m, const LocalRays& rays, double range_m,
                                     const MarkerVariance& variance) noexcept {
  const Result<WeightedMarker> none{{}, Reason::out_of_range};
  // Dual basis of (along_x, along_y) in their plane: it yields du and dv.
  const double xx = rays.along_x.squaredNorm(), yy = rays.along_y.squaredNorm();
  const double xy = rays.along_x.dot(rays.along_y);
  const double area = xx * yy - xy * xy;
  const double first = variance.xx_px2;
  const double second = variance.yy_px2 - variance.xy_px2 * variance.xy_px2 / first;
  const bool positive = area > 0 && first > 0 && second > 0 && variance.range_m2 > 0 && range_m > 0;
  if (!positive) return none;
  const Vector3 per_x = (yy * rays.along_x - xy * rays.along_y) / area;
  const Vector3 per_y = (xx * rays.along_y - xy * rays.along_x) / area;
  Result<WeightedMarker> out;
  WeightedMarker& marker = out.value;
  marker.model_m = model_m;
  marker.ray = rays.ray;
  marker.range_m = range_m;
  marker.across_first = per_x / std::sqrt(first);
  marker.across_second = (per_y - per_x * (variance.xy_px2 / first)) / std::sqrt(second);
  marker.per_range_sigma = 1 / std::sqrt(variance.range_m2);
  const double sum = marker.model_m.sum() + marker.ray.sum() + marker.range_m +
                     marker.across_first.sum() + marker.across_second.sum() +
                     marker.per_range_sigma;
  return std::isfinite(sum) ? out : none;
}

}  // namespace glint
