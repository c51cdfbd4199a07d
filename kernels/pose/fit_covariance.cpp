#include "kernels/pose/fit_covariance.hpp"

#include <cmath>

#include "kernels/pose/rigid_fit.hpp"

namespace glint {
namespace {

using Jacobian = Eigen::Matrix<double, 3, 6>;

// How a point moves with a shift and a small rotation about the reference.
Jacobian point_by_pose(const Vector3& lever) {
  Jacobian j;
  j << 1, 0, 0, 0, lever.z(), -lever.y(),  //
      0, 1, 0, -lever.z(), 0, lever.x(),   //
      0, 0, 1, lever.y(), -lever.x(), 0;
  return j;
}

// Moves the reference of a pose's covariance by `offset`.
Matrix6 moved(const Matrix6& covariance, const Vector3& offset) {
  Matrix6 j = Matrix6::Identity();
  j.topRows<3>() = point_by_pose(offset);
  return j * covariance * j.transpose();
}

// The inverse of a symmetric positive matrix; not finite where it is not positive. By hand, for
// Eigen's way to it leads past a size of cache blocks behind a lock and past a heap. Golub and Van
// Loan 2013, algorithm 4.2.1 and equations (3.1.2), (3.1.4).
Matrix6 inverse_by_cholesky(const Matrix6& matrix) {
  Matrix6 lower = Matrix6::Zero();
  for (int c = 0; c < 6; ++c) {
    for (int r = c; r < 6; ++r) {
      double rest = matrix(r, c);
      for (int k = 0; k < c; ++k) rest -= lower(r, k) * lower(c, k);
      lower(r, c) = r == c ? std::sqrt(rest) : rest / lower(c, c);
    }
  }
  Matrix6 inverse = Matrix6::Identity();
  for (int c = 0; c < 6; ++c) {
    for (int r = 0; r < 6; ++r) {
      for (int k = 0; k < r; ++k) inverse(r, c) -= lower(r, k) * inverse(k, c);
      inverse(r, c) /= lower(r, r);
    }
    for (int r = 5; r >= 0; --r) {
      for (int k = r + 1; k < 6; ++k) inverse(r, c) -= lower(k, r) * inverse(k, c);
      inverse(r, c) /= lower(r, r);
    }
  }
  return inverse;
}

}  // namespace

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
  // About the markers' mean shift and rotation separate, so the inverse keeps its digits however
  // far away the reference is.
  Vector3 mean = Vector3::Zero();
  for (const Vector3& point : points_m) mean += point;
  mean /= static_cast<double>(points_m.size());
  Matrix6 normal = Matrix6::Zero();
  Matrix6 spread = Matrix6::Zero();
  for (std::size_t i = 0; i < points_m.size(); ++i) {
    const Jacobian j = point_by_pose(points_m[i] - mean);
    normal += j.transpose() * j;
    spread += j.transpose() * covariances_m2[i] * j;
  }
  const Matrix6 inverse = inverse_by_cholesky(normal);
  const Matrix6 about_mean = inverse * spread * inverse;
  const Matrix6 about_reference = moved(about_mean, reference_m - mean);
  if (!std::isfinite(about_reference.sum())) {
    result.reason = Reason::out_of_range;
    return result;
  }
  result.value = 0.5 * (about_reference + about_reference.transpose());
  return result;
}

}  // namespace glint
