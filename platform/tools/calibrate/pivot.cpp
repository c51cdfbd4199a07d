#include "platform/tools/calibrate/pivot.hpp"

#include <algorithm>
#include <cmath>

#include "platform/dense.hpp"
#include "platform/input_error.hpp"
#include "platform/tools/calibrate/correlation.hpp"
#include "platform/tools/calibrate/figure_text.hpp"
#include "platform/tools/calibrate/pivot_linear.hpp"
#include "platform/tools/calibrate/pivot_refine.hpp"
#include "platform/tools/calibrate/robust.hpp"

namespace glint {
namespace {

constexpr int k_pivot_first_test_poses =
    k_pivot_noise_poses_min;  // poses before the first test of the tip's sigma
constexpr int k_refine_rounds = 3;

std::vector<PivotSample> samples_of(std::span<const TimedPose> poses, const Vector3& centre_m) {
  std::vector<PivotSample> samples;
  for (const TimedPose& pose : poses) {
    samples.push_back({pose.pose.rotation, pose.pose * centre_m, 1, 1});
  }
  return samples;
}

void set_noise(std::vector<PivotSample>& samples, const PivotNoise& noise) {
  for (PivotSample& sample : samples) {
    sample.position_sigma_m = noise.position_sigma_m;
    sample.rotation_sigma_rad = noise.rotation_sigma_rad;
  }
}

double chi_square(const PivotSample& sample, const PivotPoint& point) {
  const Vector3 miss = pivot_residual_of(sample, point);
  return miss.dot(residual_covariance(sample, point).inverse() * miss);
}

std::vector<bool> inliers_of(const std::vector<PivotSample>& samples, const PivotPoint& point,
                             double limit) {
  std::vector<bool> kept;
  for (const PivotSample& sample : samples) kept.push_back(chi_square(sample, point) <= limit);
  return kept;
}

double variance_inflation_of(const std::vector<PivotSample>& kept, const PivotPoint& point) {
  std::vector<Vector3> misses;
  for (const PivotSample& sample : kept) misses.push_back(pivot_residual_of(sample, point));
  return correlation_factor(misses);
}

// Tip covariance from the kept samples' Jacobians [R, -1], scaled by the reduced chi-square.
Matrix3 tip_covariance(const std::vector<PivotSample>& kept, const PivotPoint& point) {
  Matrix6 information = Matrix6::Zero();
  double sum = 0;
  for (const PivotSample& sample : kept) {
    Eigen::Matrix<double, 3, 6> row;
    row << sample.rotation.toRotationMatrix(), -Matrix3::Identity();
    information += row.transpose() * residual_covariance(sample, point).inverse() * row;
    sum += chi_square(sample, point);
  }
  const double degrees_of_freedom = 3.0 * static_cast<double>(kept.size()) - 6.0;
  return inverse_of(information).topLeftCorner<3, 3>() * (sum / degrees_of_freedom);
}

// Returns whether these first poses reach stop_sigma_m; uses the linear solution only.
bool reaches_sigma(const std::vector<PivotSample>& samples, std::span<const TimedPose> poses,
                   const PivotSettings& settings) {
  std::vector<PivotSample> known = samples;
  const PivotPoint point = robust_pivot(known);
  set_noise(known, pivot_noise(known, point));
  const std::vector<bool> near = inliers_of(known, point, settings.inlier_chi_square);
  const std::vector<PivotSample> kept = kept_of(known, near);
  const std::vector<TimedPose> moved = kept_of(poses, near);
  if (kept.size() < static_cast<std::size_t>(k_pivot_poses_min) ||
      rotation_spread(moved).spread_rad[0] < settings.spread_min_rad)
    return false;
  return largest_sigma(tip_covariance(kept, point) * variance_inflation_of(kept, point)) <=
         settings.stop_sigma_m;
}

std::size_t poses_needed(std::span<const TimedPose> poses, const PivotSettings& settings) {
  if (settings.stop_sigma_m <= 0) return poses.size();
  for (std::size_t n = k_pivot_first_test_poses; n < poses.size(); n += n / 4) {
    if (reaches_sigma(samples_of(poses.first(n), settings.centre_m), poses.first(n), settings))
      return n;
  }
  return poses.size();
}

void check_motion(const PivotResult& result, const PivotSettings& settings,
                  const std::string& what) {
  if (result.spread.spread_rad[0] >= settings.spread_min_rad) return;
  throw InputError(what + ": the tool's direction " +
                   format_direction(result.spread.directions.col(0)) + " moved by only " +
                   format_degrees(result.spread.spread_rad[0]) +
                   " rms, so the tip along it is not observable; expected at least " +
                   format_degrees(settings.spread_min_rad) +
                   ": tilt the tool to all sides with its tip at rest");
}

void check_fit(const PivotResult& result, const PivotSettings& settings, const std::string& what) {
  const auto kept = static_cast<double>(result.poses_used - result.outliers);
  if (kept >= settings.inliers_min * result.poses_used && result.rms_m <= settings.rms_max_m)
    return;
  throw InputError(what + ": " + std::to_string(result.outliers) + " of " +
                   std::to_string(result.poses_used) +
                   " poses do not fit, the others have residuals of " + format_mm(result.rms_m) +
                   " rms; expected at most half and " + format_mm(settings.rms_max_m) +
                   ": hold the tip at rest in a dent");
}

}  // namespace

PivotResult calibrate_pivot(std::span<const TimedPose> poses, const PivotSettings& settings,
                            const std::string& what) {
  if (poses.size() < static_cast<std::size_t>(k_pivot_poses_min)) {
    throw InputError(what + ": " + std::to_string(poses.size()) + " poses; expected at least " +
                     std::to_string(k_pivot_poses_min) + " with the tip at rest");
  }
  poses = poses.first(poses_needed(poses, settings));
  std::vector<PivotSample> samples = samples_of(poses, settings.centre_m);
  PivotPoint point = robust_pivot(samples);

  PivotResult result;
  result.poses_used = static_cast<int>(samples.size());
  const bool few_poses = result.poses_used < k_pivot_noise_poses_min;
  const double gate = (few_poses ? 9 : 1) * settings.inlier_chi_square;
  for (int round = 0; round < k_refine_rounds; ++round) {
    set_noise(samples,
              few_poses ? isotropic_pivot_noise(samples, point) : pivot_noise(samples, point));
    result.kept = inliers_of(samples, point, gate);
    const std::vector<TimedPose> moved = kept_of(poses, result.kept);
    result.spread = rotation_spread(moved);
    check_motion(result, settings, what);
    point = few_poses    ? unweighted_pivot(kept_of(samples, result.kept))
            : round == 0 ? refined_pivot(samples, point, PivotLoss::cauchy)
                         : refined_pivot(kept_of(samples, result.kept), point, PivotLoss::none);
  }

  const std::vector<PivotSample> kept = kept_of(samples, result.kept);
  double squares = 0;
  for (const PivotSample& sample : samples) {
    result.distances_m.push_back(pivot_residual_of(sample, point).norm());
  }
  for (const PivotSample& sample : kept) squares += pivot_residual_of(sample, point).squaredNorm();
  result.tip_m = point.lever_m + settings.centre_m;
  result.post_m = point.post_m;
  result.rms_m = std::sqrt(squares / static_cast<double>(kept.size()));
  result.outliers = static_cast<int>(samples.size() - kept.size());
  result.position_sigma_m = samples[0].position_sigma_m;
  result.rotation_sigma_rad = samples[0].rotation_sigma_rad;
  result.variance_inflation = variance_inflation_of(kept, point);
  const Vector3 scaled_m = settings.scale_sigma * (result.tip_m - settings.centre_m);
  result.tip_covariance_m2 =
      tip_covariance(kept, point) * result.variance_inflation + scaled_m * scaled_m.transpose();
  result.tip_sigma_m = largest_sigma(result.tip_covariance_m2);
  result.sigma_reached = settings.stop_sigma_m <= 0 || result.tip_sigma_m <= settings.stop_sigma_m;
  check_fit(result, settings, what);
  return result;
}

}  // namespace glint
