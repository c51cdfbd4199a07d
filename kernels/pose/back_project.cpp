#include "kernels/pose/back_project.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "kernels/pose/depth_samples.hpp"
#include "kernels/pose/local_rays.hpp"
#include "kernels/pose/robust_mean.hpp"
#include "kernels/shared_budget.hpp"

namespace glint {
namespace {

// Upper limit on s / radius: near the limb a pixel's depth differs from that at its centre.
constexpr double k_limb_part = 0.95;
// The inner disc is used if at least this part of its pixels has usable depth.
constexpr double k_inner_valid_part = 0.25;
// Weight of the declared pixel variance beside the observed spread, in ranges.
constexpr double k_declared_weight = 2;
// Range bias on a sphere of the nominal radius: from the inner disc; from the annulus; from the
// annulus of a fully saturated sphere, whose remaining pixels are mixed with the background. See
// the header.
constexpr double k_bias_m = 0.0001, k_annulus_bias_m = 0.001, k_saturated_bias_m = 0.0035;
// A blob is more than one marker if its area exceeds by this factor that of a disc, widened by
// k_widening_px in the lens.
constexpr double k_merged_part = 1.5;
constexpr double k_widening_px = 1.0;

// Reduces ranges to the nearest surface point of a sphere (radius > 0).
TwoDoubles nearest_surface_of(const DepthSamples& samples, std::size_t at, double wrapped_m,
                              double radius_m) {
  const TwoDoubles range = (load_two(&samples.range_m[at]) + broadcast_two(wrapped_m)) *
                           load_two(&samples.radial_factor[at]);
  if (!(radius_m > 0)) return range;
  const double curl = k_limb_part * radius_m;
  const TwoDoubles beside =
      minimum(range * range * load_two(&samples.offset_square[at]), broadcast_two(curl * curl));
  const TwoDoubles depth =
      broadcast_two(radius_m) - square_root(broadcast_two(radius_m * radius_m) - beside);
  return range - (depth - broadcast_two(0.5) * beside / (range + broadcast_two(radius_m)));
}

// Robust mean of the samples, reduced to the nearest surface point. unwrapped() averages the
// inliers again with the wrap distance added: a pixel's distance from the centre ray grows with its
// range.
class NearestSurfaceMean {
 public:
  NearestSurfaceMean(const DepthSamples& samples, double radius_m, double unit_m)
      : samples_(samples), radius_m_(radius_m), count_(static_cast<std::size_t>(samples.count)) {
    for (std::size_t i = 0; i < count_; i += 2) {
      store_two(nearest_surface_of(samples, i, 0, radius_m), &fronts_[i]);
    }
    // The gate is at least one depth count.
    found_ = robust_mean(fronts_, samples.count, unit_m);
    // The padding of an odd count must not be an inlier.
    if (count_ % 2 == 1) fronts_[count_] = std::numeric_limits<double>::infinity();
  }
  [[nodiscard]] double value() const { return found_.mean; }
  // Variance of the mean of n ranges with the spread s: s^2 / n; for small n the declared variance
  // also enters, since few ranges do not determine s.
  [[nodiscard]] double variance(double declared_sigma_m) const {
    const double spread = found_.gate / 3, n = std::max(found_.near, 1);
    return (n * spread * spread + k_declared_weight * declared_sigma_m * declared_sigma_m) /
           ((n + k_declared_weight) * n);
  }
  [[nodiscard]] double unwrapped(double wrapped_m) const {
    NearSum near;
    for (std::size_t i = 0; i < count_; i += 2) {
      near.add(found_, load_two(&fronts_[i]),
               nearest_surface_of(samples_, i, wrapped_m, radius_m_));
    }
    return near.mean_or(found_.mean + wrapped_m);
  }

 private:
  const DepthSamples& samples_;
  double radius_m_;
  std::size_t count_;
  RangeValues fronts_;
  RobustMean found_;
};

// Ratio (>= 1) between the blob's radius at this range and the nominal one; 1 fits best.
double size_misfit(const DepthView& view, double radius_m, double nearest_surface_m) {
  const double steradian = view.blob.area_px * view.rays.steradian_per_pixel();
  const double ratio =
      std::sqrt(steradian / std::numbers::pi) * (nearest_surface_m + radius_m) / radius_m;
  return ratio >= 1 ? ratio : 1 / std::max(ratio, 1e-9);
}

// The size of a blob cut by the image border is not usable.
bool has_wrapped(const DepthView& view, double radius_m, double nearest_surface_m) {
  const double wrap_m = view.depth.wrap_range_m;
  if (!(wrap_m > 0) || !(radius_m > 0)) return false;
  if (view.blob.flags & k_blob_touches_edge) return false;
  return size_misfit(view, radius_m, nearest_surface_m + wrap_m) <
         size_misfit(view, radius_m, nearest_surface_m);
}

// Computes the range; returns the loop counts.
BackProjectWork measure_range(const DepthView& view, const NominalMarker& nominal,
                              const MarkerWorkLimits& limits, Marker& out) {
  BackProjectWork work;
  DepthSamples samples;
  bool from_annulus = false;
  if (!view.frame.depth.empty()) {
    const double radius_px = std::sqrt(std::min<double>(view.blob.area_px, 1e6) / std::numbers::pi);
    inner_samples(view, radius_px, limits.samples, samples);
    work.pixels = samples.pixels;
    from_annulus = samples.count == 0 || samples.usable < k_inner_valid_part * samples.tried;
    if (from_annulus) {
      annulus_samples(view, radius_px, limits.samples, limits.pixels - samples.pixels, samples);
      work.pixels += samples.pixels;
    }
  }
  if (samples.count == 0) {
    out.flags |= k_marker_no_depth;
    return work;
  }
  work.samples = samples.count;
  const double curved_m = nominal.shape == MarkerShape::sphere ? nominal.radius_m : 0;
  const NearestSurfaceMean front(samples, curved_m, view.depth.unit_m);
  out.surface_range_m = front.value();
  if (has_wrapped(view, nominal.radius_m, out.surface_range_m)) {
    out.surface_range_m = front.unwrapped(view.depth.wrap_range_m);
    out.flags |= k_marker_wrapped;
    work.unwrapped = samples.count;
  }
  const double bias_m = view.depth.bias.at(out.surface_range_m, view.blob.peak);
  out.surface_range_m -= bias_m;
  out.bias_subtracted_m = static_cast<float>(bias_m);
  out.peak = view.blob.peak;
  if (from_annulus) out.flags |= k_marker_annulus_depth;
  const bool saturated = (view.blob.flags & k_blob_saturated) != 0;
  const double bias = !from_annulus ? k_bias_m : saturated ? k_saturated_bias_m : k_annulus_bias_m;
  out.range_sigma_m =
      static_cast<float>(std::sqrt(front.variance(view.depth.pixel_sigma_m) + bias * bias));
  return work;
}

// Component of a ray's change that is perpendicular to the slightly moved ray.
Vector3 perpendicular_part(const Vector3& ray, const Vector3& change) {
  return change - ray * ray.dot(change);
}

// Moves a sphere's centroid to the projection of its centre. Flags a blob larger than one marker
// and inflates its sigma.
void correct_centroid(const DepthView& view, const SphereOffset& shift,
                      const NominalMarker& nominal, Marker& out) {
  if (!(nominal.radius_m > 0) || !(out.surface_range_m > 0)) return;
  const LocalRays& rays = view.rays;
  const bool sphere = nominal.shape == MarkerShape::sphere;
  const double sine = nominal.radius_m / (out.surface_range_m + (sphere ? nominal.radius_m : 0));
  if (sphere) {
    const Vector2 moved = offset_px(shift, out.centroid_px, sine);
    out.centroid_px -= moved;
    out.ray = (rays.ray - rays.along_x * moved.x() - rays.along_y * moved.y()).normalized();
    out.along_x = perpendicular_part(out.ray, rays.along_x);
    out.along_y = perpendicular_part(out.ray, rays.along_y);
  }
  const double radius_px = sine / std::sqrt(rays.steradian_per_pixel());
  const double widened = radius_px + k_widening_px;
  if (out.flags & k_marker_touches_edge) return;
  if (!(out.area_px > k_merged_part * std::numbers::pi * widened * widened)) return;
  out.flags |= k_marker_not_isolated;
  for (float& sigma : out.sigma_px) sigma += static_cast<float>(radius_px);
}

struct Measured {
  bool has_ray = false;
  BackProjectWork work;
};

Measured measure(const Frame& frame, const Blob& blob, std::uint16_t blob_index,
                 const CameraModel& camera, const SphereOffset& shift, const DepthSettings& depth,
                 const NominalMarker& nominal, const MarkerWorkLimits& limits, Marker& out) {
  Measured measured;
  int lens_steps = 0;
  const Result<LocalRays> rays = local_rays(camera, blob.centroid_px, limits.ray_steps, lens_steps);
  measured.has_ray = static_cast<bool>(rays);
  if (rays) {
    out = {};
    out.ray = rays.value.ray;
    out.along_x = rays.value.along_x;
    out.along_y = rays.value.along_y;
    out.centroid_px = blob.centroid_px;
    out.area_px = blob.area_px;
    out.blob = blob_index;
    if (blob.flags & k_blob_saturated) out.flags |= k_marker_saturated;
    if (blob.flags & k_blob_touches_edge) out.flags |= k_marker_touches_edge;
    if (blob.flags & k_blob_has_neighbour) out.flags |= k_marker_has_neighbour;
    if (blob.flags & k_blob_partial_or_merged) out.flags |= k_marker_not_isolated;
    out.sigma_px = {std::sqrt(blob.variance_px2[0]), std::sqrt(blob.variance_px2[1])};
    const DepthView view{frame, blob, depth, rays.value};
    measured.work = measure_range(view, nominal, limits, out);
    correct_centroid(view, shift, nominal, out);
  }
  measured.work.blobs = 1;
  measured.work.lens_steps = lens_steps;
  return measured;
}

}  // namespace

bool measure_marker(const Frame& frame, const Blob& blob, std::uint16_t blob_index,
                    const CameraModel& camera, const SphereOffset& shift,
                    const DepthSettings& depth, const NominalMarker& nominal, Marker& out,
                    const MarkerWorkLimits& limits) noexcept {
  return measure(frame, blob, blob_index, camera, shift, depth, nominal, limits, out).has_ray;
}

BackProjectWork back_project(const Frame& frame, const Blobs& blobs, const CameraModel& camera,
                             const SphereOffset& shift, const DepthSettings& depth,
                             const NominalMarker& nominal, Markers& out,
                             const Limits& limits) noexcept {
  BackProjectWork work;
  out.count = 0;
  out.incomplete = blobs.incomplete;
  const int count = std::clamp(blobs.count, 0, std::min(limits.blobs, k_blobs_max));
  SharedBudget pixels(limits.range_pixels_per_blob, limits.blobs, count);
  SharedBudget samples(limits.range_samples_per_blob, limits.blobs, count);
  for (int i = 0; i < count; ++i) {
    const Measured one = measure(frame, blobs.items[static_cast<std::size_t>(i)],
                                 static_cast<std::uint16_t>(i), camera, shift, depth, nominal,
                                 {pixels.next_max(), samples.next_max(), limits.ray_steps},
                                 out.items[static_cast<std::size_t>(out.count)]);
    out.count += one.has_ray ? 1 : 0;
    pixels.spend(one.work.pixels);
    samples.spend(one.work.samples);
    work.blobs += one.work.blobs;
    work.lens_steps += one.work.lens_steps;
    work.pixels += one.work.pixels;
    work.samples += one.work.samples;
    work.unwrapped += one.work.unwrapped;
  }
  return work;
}

double expected_area_px(const CameraModel& camera, const Vector2& pixel, double radius_m,
                        double range_m) noexcept {
  int lens_steps = 0;
  const Result<LocalRays> rays = local_rays(camera, pixel, k_ray_steps_max, lens_steps);
  if (!rays || !(range_m > 0)) return 0;
  const double steradian = rays.value.steradian_per_pixel();
  const double part = radius_m / range_m;
  return steradian > 0 ? std::numbers::pi * part * part / steradian : 0;
}

}  // namespace glint
