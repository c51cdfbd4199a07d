#include "kernels/pose/depth_flip.hpp"

#include <algorithm>
#include <cmath>

namespace glint {
namespace {

// Scaled to a largest element of 1, so that powers neither underflow nor overflow.
Matrix3 scaled(const Matrix3& matrix) {
  const double largest = std::max({matrix(0, 0), matrix(1, 1), matrix(2, 2)});
  return largest > 0 ? Matrix3(matrix / largest) : Matrix3::Identity();
}

Matrix3 adjugate_of(const Matrix3& spread) {
  Matrix3 out;
  out.col(0) = spread.col(1).cross(spread.col(2));
  out.col(1) = spread.col(2).cross(spread.col(0));
  out.col(2) = spread.col(0).cross(spread.col(1));
  return out;
}

Vector3 unit_or(const Vector3& v, const Vector3& otherwise) {
  const double square = v.squaredNorm();
  return square > 0 ? Vector3(v / std::sqrt(square)) : otherwise;
}

}  // namespace

Vector3 flattest_direction(std::span<const WeightedMarker> markers,
                           const Vector3& mean_m) noexcept {
  Matrix3 spread = Matrix3::Zero();
  for (const WeightedMarker& marker : markers) {
    const Vector3 offset = marker.model_m - mean_m;
    spread += offset * offset.transpose();
  }
  Matrix3 power = scaled(adjugate_of(scaled(spread)));
  for (int square = 0; square < 3; ++square) power = scaled(power * power);
  int longest = 0;
  for (int c = 1; c < 3; ++c) longest = power(c, c) > power(longest, longest) ? c : longest;
  return unit_or(power.col(longest), Vector3::UnitZ());
}

Pose depth_flipped(const Pose& T_camera_tool, const Vector3& flattest,
                   const Vector3& mean_m) noexcept {
  const Vector3 mean = T_camera_tool * mean_m;
  const Vector3 view = unit_or(mean, Vector3::UnitZ());
  const Vector3 normal = T_camera_tool.rotation * flattest;
  // A unit vector as a quaternion is a half turn; two successive reflections are their product.
  const Quaternion v(0, view.x(), view.y(), view.z());
  const Quaternion n(0, normal.x(), normal.y(), normal.z());
  Pose flipped;
  flipped.rotation = (v * n * T_camera_tool.rotation).normalized();
  flipped.translation = mean - flipped.rotation * mean_m;
  return flipped;
}

}  // namespace glint
