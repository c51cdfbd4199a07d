#include "kernels/pose/noise_estimate.hpp"

#include <algorithm>
#include <cmath>

#include "kernels/pose/normal_equations.hpp"

namespace glint {
namespace {

// Squared: a residual beyond three sigma is clipped to three.
constexpr double k_clip_square = 9;

// Leverage: y' y of L y = gradient, the part of a residual's variance that the fit absorbs.
double leverage_of(const PoseFactor& factor, const Vector3& gradient, const Vector3& lever) {
  Vector6 y;
  y << gradient, lever.cross(gradient);
  for (int c = 0; c < 6; ++c) {
    y(c) *= factor.inverse_diagonal(c);
    for (int r = c + 1; r < 6; ++r) y(r) -= factor.lower(r, c) * y(c);
  }
  return std::min(y.squaredNorm(), 1.0);
}

// Weighted sum of the residuals of one kind: ranges or pixels.
class Kind {
 public:
  // declared: the part of the variance that is common to all markers.
  explicit Kind(double declared) : declared_(declared) {}

  // sigmas: the residual divided by its standard deviation.
  void add(double sigmas, double leverage, double variance) {
    const double share = declared_ / variance, weight = share * share, free = 1 - leverage;
    const double own = std::max(variance - declared_, 0.0);
    const double square = std::min(sigmas * sigmas, k_clip_square * free) * variance;
    sum_.squares += weight * (square - free * own);
    sum_.redundancy += weight * free;
  }
  [[nodiscard]] const ResidualSum& sum() const { return sum_; }

 private:
  double declared_;
  ResidualSum sum_;
};

double variance_of(double sigma) { return sigma * sigma; }

// Updates the sum and returns the variance of all ranges or pixels; the declared one has the weight
// of some residuals.
double update(const ResidualSum& newest, double declared, double least, double most,
              bool has_residuals, ResidualSum& sum) {
  if (!has_residuals)
    sum = {k_noise_declared_weight * declared, k_noise_declared_weight, k_noise_declared_weight};
  const double kept = std::max(0.0, 1 - newest.redundancy / k_noise_memory);
  sum.squares = kept * sum.squares + newest.squares;
  sum.redundancy = kept * sum.redundancy + newest.redundancy;
  sum.declared *= kept;
  return std::clamp(sum.squares / sum.redundancy, least, most);
}

// Ratio of the estimate with the largest variance as initial value to the current one; at least 1.
double inflation_of(const ResidualSum& sum, double sigma, double declared_sigma) {
  const double open = k_noise_inflated_weight * sum.declared / k_noise_declared_weight;
  const double seen = sum.redundancy - sum.declared;
  const double largest =
      k_noise_variance_inflation * variance_of(declared_sigma) / variance_of(sigma);
  return std::max(1.0, (seen + open * largest) / (seen + open));
}

}  // namespace

double variance_inflation(const NoiseEstimate& estimate, const MarkerNoise& declared) noexcept {
  if (!estimate.has_residuals) return k_noise_variance_inflation;
  return std::max(
      inflation_of(estimate.sums.range, estimate.range_sigma_m, declared.range_sigma_m),
      inflation_of(estimate.sums.pixel, estimate.pixel_sigma_px, declared.pixel_sigma_px));
}

MarkerResiduals residuals_of(std::span<const WeightedMarker> markers,
                             std::span<const MarkerVariance> variances, const Pose& T_camera_tool,
                             const MarkerNoise& noise) noexcept {
  const Vector3 mean_m = mean_of(markers);
  NormalEquations normal;
  if (markers.empty() || !add_markers(markers, T_camera_tool, mean_m, normal)) return {};
  const Result<PoseFactor> factor = pose_factor(normal.matrix);
  if (!factor) return {};
  Kind range(variance_of(noise.range_sigma_m));
  Kind pixel(variance_of(noise.pixel_sigma_px));
  for (std::size_t i = 0; i < markers.size(); ++i) {
    const WeightedMarker& marker = markers[i];
    const Vector3 lever = T_camera_tool.rotation * (marker.model_m - mean_m);
    const Vector3 point = T_camera_tool * marker.model_m;
    const double distance = point.norm();
    range.add((distance - marker.range_m) * marker.per_range_sigma,
              leverage_of(factor.value, point * (marker.per_range_sigma / distance), lever),
              variances[i].range_m2);
    const double inverse = 1 / marker.ray.dot(point);
    const auto add_pixel = [&](const Vector3& across, double variance) {
      const double sigmas = across.dot(point) * inverse;
      pixel.add(sigmas, leverage_of(factor.value, (across - marker.ray * sigmas) * inverse, lever),
                variance);
    };
    add_pixel(marker.across_first, variances[i].xx_px2);
    add_pixel(marker.across_second, variances[i].yy_px2);
  }
  return {range.sum(), pixel.sum()};
}

void add(const MarkerResiduals& residuals, const MarkerNoise& declared,
         NoiseEstimate& estimate) noexcept {
  if (!(residuals.range.redundancy > 0 && residuals.pixel.redundancy > 0)) return;
  estimate.range_sigma_m = std::sqrt(
      update(residuals.range, variance_of(declared.range_sigma_m), variance_of(k_range_sigma_min_m),
             variance_of(k_range_sigma_max_m), estimate.has_residuals, estimate.sums.range));
  estimate.pixel_sigma_px = std::sqrt(update(
      residuals.pixel, variance_of(declared.pixel_sigma_px), variance_of(k_pixel_sigma_min_px),
      variance_of(k_pixel_sigma_max_px), estimate.has_residuals, estimate.sums.pixel));
  estimate.has_residuals = true;
}

}  // namespace glint
