#include "platform/tools/calibrate/pivot_linear.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "platform/dense.hpp"
#include "platform/tools/calibrate/robust.hpp"

namespace glint {
namespace {

constexpr int k_huber_rounds = 30;
constexpr double k_huber_medians = 1.0;  // a distance up to the median has full weight

// Files resolve a micrometre at best: smaller noise is rounding only.
constexpr double k_position_sigma_min_m = 1e-6;
constexpr double k_rotation_sigma_min_rad = 1e-6;

}  // namespace

PivotPoint weighted_pivot(std::span<const PivotSample> samples, std::span<const double> weights) {
  // Unknowns: lever and post. Row block [R, -1], right-hand side -centre.
  Matrix6 normal = Matrix6::Zero();
  Eigen::Matrix<double, 6, 1> right = Eigen::Matrix<double, 6, 1>::Zero();
  for (std::size_t i = 0; i < samples.size(); ++i) {
    Eigen::Matrix<double, 3, 6> row;
    row << samples[i].rotation.toRotationMatrix(), -Matrix3::Identity();
    normal += weights[i] * row.transpose() * row;
    right -= weights[i] * row.transpose() * samples[i].centre_m;
  }
  const Eigen::Matrix<double, 6, 1> solution = solve_symmetric(normal, right);
  return {solution.head<3>(), solution.tail<3>()};
}

PivotPoint unweighted_pivot(std::span<const PivotSample> samples) {
  return weighted_pivot(samples, std::vector<double>(samples.size(), 1.0));
}

Vector3 pivot_residual_of(const PivotSample& sample, const PivotPoint& point) {
  return sample.rotation * point.lever_m + sample.centre_m - point.post_m;
}

PivotPoint robust_pivot(std::span<const PivotSample> samples) {
  std::vector<double> weights(samples.size(), 1.0);
  PivotPoint point = weighted_pivot(samples, weights);
  std::vector<double> distances(samples.size());
  for (int round = 0; round < k_huber_rounds; ++round) {
    for (std::size_t i = 0; i < samples.size(); ++i) {
      distances[i] = pivot_residual_of(samples[i], point).norm();
    }
    const double limit = k_huber_medians * median_of(distances);
    for (std::size_t i = 0; i < samples.size(); ++i) {
      weights[i] = distances[i] > limit ? limit / distances[i] : 1.0;
    }
    const PivotPoint next = weighted_pivot(samples, weights);
    const double step = (next.lever_m - point.lever_m).norm() + (next.post_m - point.post_m).norm();
    point = next;
    if (!(step > 1e-9)) break;
  }
  return point;
}

PivotNoise pivot_noise(std::span<const PivotSample> samples, const PivotPoint& point) {
  const double lever = point.lever_m.norm();
  std::vector<double> along, across;
  for (const PivotSample& sample : samples) {
    const Vector3 miss = pivot_residual_of(sample, point);
    const Vector3 direction =
        lever > 1e-9 ? Vector3(sample.rotation * point.lever_m / lever) : Vector3(Vector3::UnitX());
    const Vector3 first = direction.unitOrthogonal();
    along.push_back(miss.dot(direction));
    across.push_back(miss.dot(first));
    across.push_back(miss.dot(direction.cross(first)));
  }
  const double position = std::max(sigma_of(along), k_position_sigma_min_m);
  const double sideways = sigma_of(across);
  if (!(lever > 1e-3 && sideways > position)) return isotropic_pivot_noise(samples, point);
  const double turned = std::sqrt(sideways * sideways - position * position) / lever;
  return {position, std::max(turned, k_rotation_sigma_min_rad)};
}

PivotNoise isotropic_pivot_noise(std::span<const PivotSample> samples, const PivotPoint& point) {
  std::vector<double> components;
  for (const PivotSample& sample : samples) {
    const Vector3 miss = pivot_residual_of(sample, point);
    for (int axis = 0; axis < 3; ++axis) components.push_back(miss[axis]);
  }
  return {std::max(sigma_of(components), k_position_sigma_min_m), k_rotation_sigma_min_rad};
}

Matrix3 residual_covariance(const PivotSample& sample, const PivotPoint& point) {
  const Vector3 lever = sample.rotation * point.lever_m;
  const double turned = sample.rotation_sigma_rad * sample.rotation_sigma_rad;
  const double moved = sample.position_sigma_m * sample.position_sigma_m;
  return (moved + turned * lever.squaredNorm()) * Matrix3::Identity() -
         turned * lever * lever.transpose();
}

}  // namespace glint
