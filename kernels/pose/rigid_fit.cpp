#include "kernels/pose/rigid_fit.hpp"

#include <cmath>

#include "kernels/pose/best_rotation.hpp"

namespace glint {
namespace {

Vector3 mean_of(std::span<const Vector3> points) {
  Vector3 sum = Vector3::Zero();
  for (const Vector3& point : points) sum += point;
  return sum / static_cast<double>(points.size());
}

// Tests the ratio of the second largest to the largest eigenvalue by invariants, without a
// decomposition. With e1 the trace and e2 the sum of the principal minors, e2/e1^2 is between 1 and
// 2 times that ratio if it is small.
Reason test_spread(const Matrix3& covariance) {
  const double e1 = covariance(0, 0) + covariance(1, 1) + covariance(2, 2);
  if (!std::isfinite(e1)) return Reason::out_of_range;
  if (e1 <= k_coincident_variance_m2) return Reason::degenerate;
  const double e2 = (covariance(0, 0) * covariance(1, 1) - covariance(0, 1) * covariance(0, 1)) +
                    (covariance(0, 0) * covariance(2, 2) - covariance(0, 2) * covariance(0, 2)) +
                    (covariance(1, 1) * covariance(2, 2) - covariance(1, 2) * covariance(1, 2));
  return e2 <= k_collinear_variance_ratio * e1 * e1 ? Reason::collinear : Reason::none;
}

// Tests if the second singular value is negligible against the first. The squares of all 2x2 minors
// sum to w0^2 w1^2 + w0^2 w2^2 + w1^2 w2^2, those of the elements to w0^2 + w1^2 + w2^2.
bool is_on_a_line(const Matrix3& c) {
  const double squares = c.squaredNorm();
  const double minors = c.col(0).cross(c.col(1)).squaredNorm() +
                        c.col(0).cross(c.col(2)).squaredNorm() +
                        c.col(1).cross(c.col(2)).squaredNorm();
  constexpr double ratio = k_collinear_variance_ratio * k_collinear_variance_ratio;
  return !(minors > ratio * squares * squares);
}

}  // namespace

Reason rotation_is_fixed_by(std::span<const Vector3> points_m) noexcept {
  if (points_m.size() < 3) return Reason::too_few_markers;
  const Vector3 mean = mean_of(points_m);
  Matrix3 covariance = Matrix3::Zero();
  for (const Vector3& point : points_m) {
    const Vector3 offset = point - mean;
    covariance += offset * offset.transpose();
  }
  return test_spread(covariance / static_cast<double>(points_m.size()));
}

RigidFit fit_rigid(std::span<const Vector3> model_m, std::span<const Vector3> measured_m) noexcept {
  RigidFit fit;
  if (model_m.size() != measured_m.size() || model_m.size() < 3) {
    fit.reason = Reason::too_few_markers;
    return fit;
  }
  const Vector3 model_mean = mean_of(model_m);
  const Vector3 measured_mean = mean_of(measured_m);
  Matrix3 model_covariance = Matrix3::Zero();
  Matrix3 cross_covariance = Matrix3::Zero();
  for (std::size_t i = 0; i < model_m.size(); ++i) {
    const Vector3 x = model_m[i] - model_mean;
    const Vector3 y = measured_m[i] - measured_mean;
    model_covariance += x * x.transpose();
    cross_covariance += y * x.transpose();
  }
  const double n = static_cast<double>(model_m.size());
  model_covariance /= n;
  cross_covariance /= n;
  fit.reason = test_spread(model_covariance);
  if (fit.reason != Reason::none) return fit;
  if (!std::isfinite(cross_covariance.sum())) {
    fit.reason = Reason::out_of_range;
    return fit;
  }

  if (is_on_a_line(cross_covariance)) {
    fit.reason = Reason::collinear;
    return fit;
  }
  fit.transform.rotation = best_rotation(cross_covariance);
  fit.transform.translation = measured_mean - fit.transform.rotation * model_mean;

  double squares = 0;
  for (std::size_t i = 0; i < model_m.size(); ++i) {
    squares += (measured_m[i] - fit.transform * model_m[i]).squaredNorm();
  }
  fit.rms_m = std::sqrt(squares / n);
  return fit;
}

}  // namespace glint
