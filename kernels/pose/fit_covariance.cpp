#include "kernels/pose/fit_covariance.hpp"

#include <cmath>

#include "kernels/pose/lever_arm.hpp"
#include "kernels/pose/pose_factor.hpp"
#include "kernels/pose/rigid_fit.hpp"

namespace glint {

Matrix3 marker_covariance(const Vector3& ray, double along_sigma_m,
                          double across_sigma_m) noexcept {
  const double across = across_sigma_m * across_sigma_m;
  const double along = along_sigma_m * along_sigma_m;
  return across * Matrix3::Identity() + (along - across) * (ray * ray.transpose());
}

Result<Matrix6> fit_covariance(std::span<const Vector3> points_m,
                               std::span<const Matrix3> covariances_m2,
                               const Vector3& reference_m) noexcept {
  Result<Matrix6> result{Matrix6::Zero()};
  result.reason = points_m.size() == covariances_m2.size() ? rotation_is_fixed_by(points_m)
                                                           : Reason::too_few_markers;
  if (result.reason != Reason::none) return result;
  // About the markers' mean, translation and rotation decouple, so the inverse keeps its digits
  // however far away the reference is.
  Vector3 mean = Vector3::Zero();
  for (const Vector3& point : points_m) mean += point;
  mean /= static_cast<double>(points_m.size());
  Matrix6 normal = Matrix6::Zero();
  Matrix6 spread = Matrix6::Zero();
  for (std::size_t i = 0; i < points_m.size(); ++i) {
    const Eigen::Matrix<double, 3, 6> j = point_by_pose(points_m[i] - mean);
    normal += j.transpose() * j;
    spread += j.transpose() * covariances_m2[i] * j;
  }
  const Result<PoseFactor> factor = pose_factor(normal);
  if (!factor) {
    result.reason = Reason::out_of_range;
    return result;
  }
  const Matrix6 inverse = factor.value.inverse();
  const Matrix6 about_mean = inverse * spread * inverse;
  const Matrix6 about_reference = moved_covariance(about_mean, reference_m - mean);
  if (!std::isfinite(about_reference.sum())) {
    result.reason = Reason::out_of_range;
    return result;
  }
  result.value = 0.5 * (about_reference + about_reference.transpose());
  return result;
}

}  // namespace glint
