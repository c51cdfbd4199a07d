#include "platform/tools/verify/joint_covariance.hpp"

#include <algorithm>
#include <cmath>

#include "kernels/pose/calibration_errors.hpp"

namespace glint {
namespace {

// (1 - e^-x) / x
double mean_of_decay(double x) { return x < 1e-3 ? 1 - 0.5 * x : (1 - std::exp(-x)) / x; }

// Covariance of the means of a unit-variance Gauss-Markov process over two windows, equal or apart.
double mean_covariance(const Touch& a, const Touch& b, double correlation_s) {
  const double x = a.seconds / correlation_s, y = b.seconds / correlation_s;
  if (&a == &b) return x < 1e-3 ? 1 : 2 / x * (1 - mean_of_decay(x));
  const double apart_s = std::abs((a.mean.time - b.mean.time).seconds());
  const double gap_s = std::max(apart_s - 0.5 * (a.seconds + b.seconds), 0.0);
  return std::exp(-gap_s / correlation_s) * mean_of_decay(x) * mean_of_decay(y);
}

// Variances of each marker's range and of its pixel to the right and down, from sigmas.
Eigen::Matrix<double, k_marker_errors, 1> variances(double range_m, double pixel_px) {
  Eigen::Matrix<double, k_marker_errors, 1> out;
  for (int m = 0; m < k_markers_per_tool_max; ++m) {
    out.segment<3>(3 * m) << range_m * range_m, pixel_px * pixel_px, pixel_px * pixel_px;
  }
  return out;
}

}  // namespace

Eigen::MatrixXd joint_covariance(std::span<const Touch> touches, const StatedErrors& stated,
                                 TouchPositions positions) {
  const CameraUncertainty& camera = stated.camera;
  const auto slow = variances(camera.correlated_range_m, camera.correlated_centroid_px);
  const auto position_variances = variances(k_range_ripple_m, k_lens_residual_px);
  const double tip_m2 = stated.tip_sigma_m * stated.tip_sigma_m;
  const auto n = static_cast<Eigen::Index>(touches.size());
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(3 * n, 3 * n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const Touch& a = touches[static_cast<std::size_t>(i)];
    for (Eigen::Index j = 0; j < n; ++j) {
      const Touch& b = touches[static_cast<std::size_t>(j)];
      const double markers =
          camera.fast_share * mean_covariance(a, b, stated.correlation.fast_s) +
          (1 - camera.fast_share) * mean_covariance(a, b, stated.correlation.slow_s);
      covariance.block<3, 3>(3 * i, 3 * j) =
          markers * (a.mean.by_markers * slow.asDiagonal() * b.mean.by_markers.transpose()) +
          mean_covariance(a, b, stated.head.rest_correlation_s) *
              (a.mean.by_head * b.mean.by_head.transpose()) +
          tip_m2 * (a.mean.rotation * b.mean.rotation.conjugate()).toRotationMatrix();
    }
    Matrix3 own = a.mean.random_m2 + mean_covariance(a, a, stated.head.motion_correlation_s) *
                                         a.mean.motion_covariance_m2;
    if (positions == TouchPositions::apart)
      own += a.mean.by_markers * position_variances.asDiagonal() * a.mean.by_markers.transpose();
    covariance.block<3, 3>(3 * i, 3 * i) += own;
  }
  return covariance;
}

Eigen::MatrixXd calibration_columns(std::span<const Touch> touches) {
  const auto n = static_cast<Eigen::Index>(touches.size());
  Eigen::MatrixXd columns(3 * n, k_calibration_errors);
  for (Eigen::Index i = 0; i < n; ++i)
    columns.middleRows<3>(3 * i) = touches[static_cast<std::size_t>(i)].mean.by_calibration;
  return columns;
}

}  // namespace glint
