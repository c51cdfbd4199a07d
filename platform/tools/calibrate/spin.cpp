#include "platform/tools/calibrate/spin.hpp"

#include <algorithm>
#include <cmath>

#include "platform/dense.hpp"
#include "platform/input_error.hpp"
#include "platform/tools/calibrate/correlation.hpp"
#include "platform/tools/calibrate/figure_text.hpp"
#include "platform/tools/calibrate/robust.hpp"
#include "platform/tools/calibrate/spin_refine.hpp"

namespace glint {
namespace {

constexpr int k_spin_first_test_poses = 30;  // poses before the first test of the sigma
constexpr double k_outlier_sigmas = 4;
constexpr double k_wobble_sigma_min_rad = 1e-7;
constexpr int k_start_rounds = 3;

std::vector<Vector3> residuals_of(std::span<const TimedPose> poses, const SpinAxis& axis) {
  std::vector<Vector3> misses;
  for (const TimedPose& pose : poses) {
    misses.push_back(pose.pose.rotation * axis.tool - axis.tracker);
  }
  return misses;
}

// The tool direction that moved least, and its mean direction in the tracker frame.
SpinAxis axis_of(std::span<const TimedPose> poses, const Vector3& towards) {
  SpinAxis axis;
  axis.tool = rotation_spread(poses).directions.col(0);
  if (axis.tool.dot(towards) < 0) axis.tool = -axis.tool;
  Vector3 sum = Vector3::Zero();
  for (const TimedPose& pose : poses) sum += pose.pose.rotation * axis.tool;
  axis.tracker = sum.norm() > 0 ? Vector3(sum.normalized()) : Vector3::UnitZ();
  return axis;
}

// Sigma of one component across the axis; the median length of the misses is 1.1774 sigma.
double wobble_sigma(const std::vector<Vector3>& misses) {
  std::vector<double> lengths;
  for (const Vector3& miss : misses) lengths.push_back(miss.norm());
  return std::max(median_of(lengths) / 1.1774, k_wobble_sigma_min_rad);
}

std::vector<bool> inliers_of(const std::vector<Vector3>& misses) {
  const double limit = k_outlier_sigmas * wobble_sigma(misses);
  std::vector<bool> kept;
  for (const Vector3& miss : misses) kept.push_back(miss.norm() <= limit);
  return kept;
}

using Across = Eigen::Matrix<double, 3, 2>;

Across across(const Vector3& axis) {
  Across basis;
  basis.col(0) = axis.unitOrthogonal();
  basis.col(1) = axis.cross(basis.col(0));
  return basis;
}

// Covariance from the Jacobians of both axes' tangents, scaled by the residual variance.
Matrix3 axis_covariance(std::span<const TimedPose> poses, const SpinAxis& axis) {
  const Across tool = across(axis.tool), tracker = across(axis.tracker);
  Eigen::Matrix4d information = Eigen::Matrix4d::Zero();
  double squares = 0;
  for (const TimedPose& pose : poses) {
    Eigen::Matrix<double, 3, 4> row;
    row << pose.pose.rotation.toRotationMatrix() * tool, -tracker;
    information += row.transpose() * row;
    squares += (pose.pose.rotation * axis.tool - axis.tracker).squaredNorm();
  }
  const double variance = squares / (2.0 * static_cast<double>(poses.size()) - 4.0);
  return tool * information.inverse().topLeftCorner<2, 2>() * tool.transpose() * variance;
}

// The tool's point nearest to its origin that stays on one line along the axis: the minimum-norm
// solution of the normal equations, which leave the direction along the axis free.
void find_foot(std::span<const TimedPose> poses, const SpinAxis& axis, SpinResult& result) {
  const Matrix3 project = Matrix3::Identity() - axis.tracker * axis.tracker.transpose();
  Matrix6 normal = Matrix6::Zero();
  Eigen::Matrix<double, 6, 1> right = Eigen::Matrix<double, 6, 1>::Zero();
  for (const TimedPose& pose : poses) {
    Eigen::Matrix<double, 3, 6> row;
    row << project * pose.pose.rotation.toRotationMatrix(), -project;
    normal += row.transpose() * row;
    right -= row.transpose() * project * pose.pose.translation;
  }
  const SymmetricEigen ways = symmetric_eigen(normal);
  const Eigen::Matrix<double, 6, 1> along = ways.vectors.transpose().lazyProduct(right);
  Eigen::Matrix<double, 6, 1> solution = Eigen::Matrix<double, 6, 1>::Zero();
  for (int i = 2; i < 6; ++i) {  // skips the two smallest: free directions along the axis
    solution += ways.vectors.col(i) * (along[i] / ways.values[i]);
  }
  result.foot_m = solution.head<3>() - axis.tool * axis.tool.dot(solution.head<3>());
  double squares = 0;
  for (const TimedPose& pose : poses) {
    const Vector3 off = pose.pose * Vector3(solution.head<3>()) - solution.tail<3>();
    squares += (project * off).squaredNorm();
  }
  result.foot_rms_m = std::sqrt(squares / static_cast<double>(poses.size()));
}

SpinAxis robust_start(std::span<const TimedPose> poses, const Vector3& towards) {
  SpinAxis axis = axis_of(poses, towards);
  for (int round = 0; round < k_start_rounds; ++round) {
    axis = axis_of(kept_of(poses, inliers_of(residuals_of(poses, axis))), towards);
  }
  return axis;
}

std::vector<Quaternion> rotations_of(std::span<const TimedPose> poses) {
  std::vector<Quaternion> rotations;
  for (const TimedPose& pose : poses) rotations.push_back(pose.pose.rotation);
  return rotations;
}

std::size_t poses_needed(std::span<const TimedPose> poses, const SpinSettings& settings) {
  if (settings.stop_sigma_rad <= 0) return poses.size();
  for (std::size_t n = k_spin_first_test_poses; n < poses.size(); n += n / 4) {
    const SpinAxis axis = robust_start(poses.first(n), settings.axis_side_m);
    const std::vector<Vector3> misses = residuals_of(poses.first(n), axis);
    const std::vector<TimedPose> kept = kept_of(poses.first(n), inliers_of(misses));
    if (rotation_spread(kept).spread_rad[1] < settings.rotation_min_rad) continue;
    const double factor = correlation_factor(residuals_of(kept, axis));
    if (largest_sigma(axis_covariance(kept, axis) * factor) <= settings.stop_sigma_rad) return n;
  }
  return poses.size();
}

void check(const SpinResult& result, const SpinSettings& settings, const std::string& what) {
  if (result.spread.spread_rad[1] < settings.rotation_min_rad) {
    throw InputError(what + ": the tool turned by only " +
                     format_degrees(result.spread.spread_rad[1]) + " rms; expected at least " +
                     format_degrees(settings.rotation_min_rad) +
                     " about one axis: roll it to and fro");
  }
  if (result.rms_rad > settings.wobble_max_rad) {
    throw InputError(what + ": no direction of the tool was constant; the least moving, " +
                     format_direction(result.axis) + ", moved by " +
                     format_degrees(result.rms_rad) + " rms; expected at most " +
                     format_degrees(settings.wobble_max_rad) +
                     ": turn the tool about one axis only");
  }
}

}  // namespace

SpinResult calibrate_spin(std::span<const TimedPose> poses, const SpinSettings& settings,
                          const std::string& what) {
  if (poses.size() < static_cast<std::size_t>(k_spin_poses_min)) {
    throw InputError(what + ": " + std::to_string(poses.size()) + " poses; expected at least " +
                     std::to_string(k_spin_poses_min) + " while the tool turns about one axis");
  }
  poses = poses.first(poses_needed(poses, settings));
  SpinAxis axis = robust_start(poses, settings.axis_side_m);
  axis = refined_axis(rotations_of(poses), axis, wobble_sigma(residuals_of(poses, axis)));

  SpinResult result;
  result.kept = inliers_of(residuals_of(poses, axis));
  const std::vector<TimedPose> kept = kept_of(poses, result.kept);
  axis = refined_axis(rotations_of(kept), axis, 0);
  for (const Vector3& miss : residuals_of(poses, axis)) result.wobble_rad.push_back(miss.norm());
  const std::vector<Vector3> misses = residuals_of(kept, axis);
  double squares = 0;
  for (const Vector3& miss : misses) squares += miss.squaredNorm();

  result.axis = axis.tool;
  result.axis_tracker = axis.tracker;
  result.rms_rad = std::sqrt(squares / static_cast<double>(kept.size()));
  result.spread = rotation_spread(kept);
  result.poses_used = static_cast<int>(poses.size());
  result.outliers = static_cast<int>(poses.size() - kept.size());
  check(result, settings, what);
  result.variance_inflation = correlation_factor(misses);
  result.axis_covariance_rad2 = axis_covariance(kept, axis) * result.variance_inflation;
  result.axis_sigma_rad = largest_sigma(result.axis_covariance_rad2);
  result.sigma_reached =
      settings.stop_sigma_rad <= 0 || result.axis_sigma_rad <= settings.stop_sigma_rad;
  find_foot(kept, axis, result);
  return result;
}

}  // namespace glint
