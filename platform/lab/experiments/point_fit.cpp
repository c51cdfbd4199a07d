#include "platform/lab/experiments/point_fit.hpp"

#include "kernels/motion/cholesky.hpp"
#include "kernels/motion/interpolate.hpp"
#include "kernels/pose/rigid_fit.hpp"

namespace glint {
namespace {

constexpr int k_steps_max = 20;
constexpr double k_step_small = 1e-9;  // convergence limit; metres and radians
constexpr double k_difference = 1e-6;  // step of the numeric Jacobian; metres and radians

using Residuals = Eigen::VectorXd;

Residuals residuals(const PointCamera& camera, const std::vector<Vector3>& model_m,
                    const std::vector<Vector3>& seen, const Pose& pose) {
  const Vector3 sigma(camera.pixel_sigma_px, camera.pixel_sigma_px, camera.range_sigma_m);
  Residuals r(static_cast<Eigen::Index>(3 * model_m.size()));
  for (std::size_t i = 0; i < model_m.size(); ++i)
    r.segment<3>(static_cast<Eigen::Index>(3 * i)) =
        (seen[i] - seen_at(camera, pose * model_m[i])).cwiseQuotient(sigma);
  return r;
}

Pose moved(const Pose& pose, const Vector6& step) {
  return {(from_rotation_vector(step.tail<3>()) * pose.rotation).normalized(),
          pose.translation + step.head<3>()};
}

}  // namespace

Vector3 seen_at(const PointCamera& camera, const Vector3& point_m) {
  return {camera.focal_px * point_m.x() / point_m.z(), camera.focal_px * point_m.y() / point_m.z(),
          point_m.norm()};
}

Result<UncertainPose> fit_points(const PointCamera& camera, const std::vector<Vector3>& model_m,
                                 const std::vector<Vector3>& seen) {
  std::vector<Vector3> points;
  for (const Vector3& s : seen) {
    const Vector3 ray(s.x() / camera.focal_px, s.y() / camera.focal_px, 1);
    points.push_back(s.z() * ray.normalized());
  }
  const RigidFit start = fit_rigid(model_m, points);
  Result<UncertainPose> result;
  result.reason = start.reason;
  if (!result) return result;
  Pose pose = start.transform;
  Matrix6 normal;
  for (int step = 0; step < k_steps_max; ++step) {
    Eigen::Matrix<double, Eigen::Dynamic, 6> jacobian(3 * model_m.size(), 6);
    for (int c = 0; c < 6; ++c) {
      const Vector6 small = k_difference * Vector6::Unit(c);
      jacobian.col(c) = (residuals(camera, model_m, seen, moved(pose, -small)) -
                         residuals(camera, model_m, seen, moved(pose, small))) /
                        (2 * k_difference);
    }
    normal = jacobian.transpose() * jacobian;
    const Cholesky<6> factor(normal);
    if (!factor.positive) {
      result.reason = Reason::degenerate;
      return result;
    }
    const Vector6 change =
        factor.solve(jacobian.transpose() * residuals(camera, model_m, seen, pose));
    pose = moved(pose, change);
    result.value.covariance = factor.inverse();
    if (change.norm() < k_step_small) break;
  }
  result.value.pose = pose;
  return result;
}

std::vector<Vector3> tool_8700339() {
  std::vector<Vector3> markers = {
      {0, 0, 0}, {0, 0.02859, 0.04102}, {0, 0, 0.088}, {0, -0.04432, 0.04045}};
  Vector3 middle = Vector3::Zero();
  for (const Vector3& marker : markers) middle += marker / static_cast<double>(markers.size());
  for (Vector3& marker : markers) marker -= middle;
  return markers;
}

}  // namespace glint
