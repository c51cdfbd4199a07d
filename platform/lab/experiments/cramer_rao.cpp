#include "platform/lab/experiments/cramer_rao.hpp"

#include <Eigen/Cholesky>
#include <cmath>

namespace glint {
namespace {

// Steps of the numerical derivative: a step moves a marker by a pixel. The rounding of a ray table
// in single precision, 3e-8 of a ray, is 1e-5 px.
constexpr double k_step_m = 0.001;
constexpr double k_step_rad = 0.01;

// Minimal parameters: translation of the reference point, then rotation about it.
Pose perturbed(const Pose& pose, const Vector3& reference_m, int parameter, double by) {
  const Vector3 axis = Vector3::Unit(parameter % 3);
  const Vector3 place = pose * reference_m;
  if (parameter < 3) return {pose.rotation, pose.translation + by * axis};
  const Quaternion rotation = Quaternion(Eigen::AngleAxisd(by, axis)) * pose.rotation;
  return {rotation, place - rotation * reference_m};
}

// Pixel and range, divided by their standard deviations.
Vector3 measured(const Camera& camera, const Vector3& point, const MarkerVariance& variance) {
  const Vector2 pixel = project(camera.model, point).value;
  return {pixel.x() / std::sqrt(variance.xx_px2), pixel.y() / std::sqrt(variance.yy_px2),
          point.norm() / std::sqrt(variance.range_m2)};
}

}  // namespace

Matrix6 cramer_rao_bound(const Camera& camera, const Tool& tool, const Pose& T_camera_tool,
                         const Vector3& reference_m, const ObservationNoise& noise) {
  const MarkerVariance variance = noise.variance();
  Matrix6 information = Matrix6::Zero();
  for (int m = 0; m < tool.marker_count; ++m) {
    const Vector3& marker = tool.markers_m[static_cast<std::size_t>(m)];
    Eigen::Matrix<double, 3, 6> jacobian;
    for (int i = 0; i < 6; ++i) {
      const double step = i < 3 ? k_step_m : k_step_rad;
      const Pose up = perturbed(T_camera_tool, reference_m, i, step);
      const Pose down = perturbed(T_camera_tool, reference_m, i, -step);
      jacobian.col(i) =
          (measured(camera, up * marker, variance) - measured(camera, down * marker, variance)) /
          (2 * step);
    }
    information += jacobian.transpose() * jacobian;
  }
  return information.llt().solve(Matrix6::Identity());
}

}  // namespace glint
