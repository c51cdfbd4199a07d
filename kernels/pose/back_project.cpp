#include "kernels/pose/back_project.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "kernels/pose/local_rays.hpp"

namespace glint {
namespace {

constexpr double k_pi = 3.14159265358979323846;
constexpr double k_inner_part = 0.7;           // of the radius: half of the disc's area
constexpr double k_inner_radius_max_px = 3.7;  // holds at most k_inner_samples_max pixel centres
constexpr double k_rim_margin_px = 0.5;        // half a pixel beyond the rim still sees the marker
// Where a sphere curls away the depth of a pixel says little about its own middle.
constexpr double k_curl_part = 0.95;
// The inner half counts as there if this part of its pixels has depth.
constexpr double k_inner_valid_part = 0.25;
// Of the distribution's median absolute deviation: 3 sigma (1.4826 makes a sigma of it).
constexpr double k_inlier_deviations = 3 * 1.4826;

struct Samples {
  std::array<double, k_ring_samples_max> front_m;  // to the front point, radial
  int count = 0;
  int tried = 0;
};

struct Measurement {
  const Frame& frame;
  const Blob& blob;
  const DepthSettings& depth;
  const NominalMarker& nominal;
  const LocalRays& rays;
  double wrapped_m = 0;  // what the sensor left out of every range
};

std::uint16_t reflectivity_at(const Frame& frame, int x, int y) {
  return frame.reflectivity_8.empty() ? frame.reflectivity_16.row(y)[x]
                                      : std::uint16_t{frame.reflectivity_8.row(y)[x]};
}

// How much further than the front point a sphere's surface is, seen s beside the middle.
double behind_front(double s, double range, double radius) {
  const double beside = std::min(s, k_curl_part * radius);
  return radius - std::sqrt(radius * radius - beside * beside) -
         0.5 * beside * beside / (range + radius);
}

// Adds the pixel if its depth is of use.
void take(const Measurement& m, int x, int y, Samples& samples) {
  const std::uint16_t raw = m.frame.depth.row(y)[x];
  if (raw == 0 || raw >= m.depth.invalid_from) return;
  if (reflectivity_at(m.frame, x, y) >= m.depth.saturated_from) return;
  const Vector3 sideways = m.rays.sideways({x + 0.5, y + 0.5});
  double range = raw * m.depth.unit_m + m.wrapped_m;
  if (m.depth.kind == DepthKind::z) {
    const Vector3 ray = m.rays.ray + sideways;
    range *= std::sqrt(ray.squaredNorm()) / std::max(ray.z(), 0.01);
  }
  if (m.nominal.shape == MarkerShape::sphere && m.nominal.radius_m > 0) {
    const double s = range * std::sqrt(sideways.squaredNorm());
    range -= behind_front(s, range, m.nominal.radius_m);
  }
  samples.front_m[static_cast<std::size_t>(samples.count++)] = range;
}

// Visits the pixels with inner <= distance < outer from the centroid, by rows.
template <class Visit>
void for_each_within(const Measurement& m, double inner, double outer, Visit visit) {
  const Vector2& middle = m.blob.centroid_px;
  const int width = std::min(m.frame.width(), m.frame.depth.width);
  const int height = std::min(m.frame.height(), m.frame.depth.height);
  const int x0 = std::max(static_cast<int>(std::floor(middle.x() - outer)), 0);
  const int y0 = std::max(static_cast<int>(std::floor(middle.y() - outer)), 0);
  const int x1 = std::min(static_cast<int>(std::floor(middle.x() + outer)) + 1, width);
  const int y1 = std::min(static_cast<int>(std::floor(middle.y() + outer)) + 1, height);
  for (int y = y0; y < y1; ++y) {
    for (int x = x0; x < x1; ++x) {
      const Vector2 away = Vector2{x + 0.5, y + 0.5} - middle;
      const double square = away.squaredNorm();
      if (square >= inner * inner && square < outer * outer) visit(x, y);
    }
  }
}

Samples inner_samples(const Measurement& m, double radius_px) {
  Samples samples;
  // A pixel's centre is at most 0.71 px from any point.
  const double outer = std::clamp(k_inner_part * radius_px, 0.72, k_inner_radius_max_px);
  for_each_within(m, 0, outer, [&](int x, int y) {
    if (samples.tried++ < k_inner_samples_max) take(m, x, y, samples);
  });
  return samples;
}

// Every n-th pixel of the ring, so that all round is heard with a bounded number.
Samples ring_samples(const Measurement& m, double radius_px) {
  Samples samples;
  const double outer = std::min(radius_px + k_rim_margin_px, k_scan_radius_max_px - 1.0);
  const double inner = std::min(k_inner_part * radius_px, outer);
  const int every =
      1 + static_cast<int>(k_pi * (outer * outer - inner * inner)) / k_ring_samples_max;
  for_each_within(m, inner, outer, [&](int x, int y) {
    if (reflectivity_at(m.frame, x, y) < m.blob.peak / 4) return;  // mostly background
    if (samples.tried++ % every == 0 && samples.count < k_ring_samples_max) take(m, x, y, samples);
  });
  return samples;
}

double median(std::array<double, k_ring_samples_max>& values, int count) {
  std::sort(values.begin(), values.begin() + count);
  const auto middle = static_cast<std::size_t>(count / 2);
  return count % 2 == 1 ? values[middle] : 0.5 * (values[middle - 1] + values[middle]);
}

// The mean of the samples near the median: mixed pixels at a rim lie metres away.
double robust_mean(Samples& samples, double unit_m) {
  const double middle = median(samples.front_m, samples.count);
  std::array<double, k_ring_samples_max> deviations{};
  for (int i = 0; i < samples.count; ++i) {
    const auto at = static_cast<std::size_t>(i);
    deviations[at] = std::abs(samples.front_m[at] - middle);
  }
  // Never narrower than one step of the sensor's counting.
  const double gate = std::max(k_inlier_deviations * median(deviations, samples.count), unit_m);
  double sum = 0;
  int inliers = 0;
  for (int i = 0; i < samples.count; ++i) {
    const double value = samples.front_m[static_cast<std::size_t>(i)];
    if (std::abs(value - middle) > gate) continue;
    sum += value;
    ++inliers;
  }
  return inliers > 0 ? sum / inliers : middle;
}

struct Range {
  double front_m = 0;
  int samples = 0;
  bool from_ring = false;
};

Range measure_range(const Measurement& m) {
  if (m.frame.depth.empty()) return {};
  const double radius_px = std::sqrt(std::min<double>(m.blob.area_px, 1e6) / k_pi);
  Samples samples = inner_samples(m, radius_px);
  const bool from_ring = samples.count == 0 || samples.count < k_inner_valid_part * samples.tried;
  if (from_ring) samples = ring_samples(m, radius_px);
  if (samples.count == 0) return {};
  return {robust_mean(samples, m.depth.unit_m), samples.count, from_ring};
}

// By what factor the blob's radius at this range misses the nominal one; 1 fits best.
double size_misfit(const Measurement& m, double front_m) {
  const double steradian = m.blob.area_px * m.rays.steradian_per_pixel();
  const double ratio =
      std::sqrt(steradian / k_pi) * (front_m + m.nominal.radius_m) / m.nominal.radius_m;
  return ratio >= 1 ? ratio : 1 / std::max(ratio, 1e-9);
}

// A blob cut by the border tells nothing by its size.
bool has_wrapped(const Measurement& m, double front_m) {
  if (!(m.depth.wrap_range_m > 0) || !(m.nominal.radius_m > 0)) return false;
  if (m.blob.flags & k_blob_touches_edge) return false;
  return size_misfit(m, front_m + m.depth.wrap_range_m) < size_misfit(m, front_m);
}

}  // namespace

bool measure_marker(const Frame& frame, const Blob& blob, std::uint16_t blob_index,
                    const CameraModel& camera, const DepthSettings& depth,
                    const NominalMarker& nominal, Marker& out) noexcept {
  const Result<LocalRays> rays = local_rays(camera, blob.centroid_px);
  if (!rays) return false;
  out = {};
  out.ray = rays.value.ray;
  out.centroid_px = blob.centroid_px;
  out.area_px = blob.area_px;
  out.blob = blob_index;
  if (blob.flags & k_blob_saturated) out.flags |= k_marker_saturated;
  if (blob.flags & k_blob_touches_edge) out.flags |= k_marker_touches_edge;

  Measurement m{frame, blob, depth, nominal, rays.value, 0};
  Range range = measure_range(m);
  if (range.samples > 0 && has_wrapped(m, range.front_m)) {
    m.wrapped_m = depth.wrap_range_m;
    range = measure_range(m);  // a pixel's distance beside the middle grows with its range
    out.flags |= k_marker_wrapped;
  }
  out.surface_range_m = range.front_m;
  if (range.samples == 0) out.flags |= k_marker_no_depth;
  if (range.samples > 0 && range.from_ring) out.flags |= k_marker_ring_depth;
  return true;
}

double expected_area_px(const CameraModel& camera, const Vector2& pixel, double radius_m,
                        double range_m) noexcept {
  const Result<LocalRays> rays = local_rays(camera, pixel);
  if (!rays || !(range_m > 0)) return 0;
  const double steradian = rays.value.steradian_per_pixel();
  const double part = radius_m / range_m;
  return steradian > 0 ? k_pi * part * part / steradian : 0;
}

}  // namespace glint
