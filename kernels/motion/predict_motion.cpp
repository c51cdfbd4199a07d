#include "kernels/motion/predict_motion.hpp"

#include "kernels/motion/interpolate.hpp"
#include "kernels/motion/occlusion_noise.hpp"
#include "kernels/motion/singer.hpp"

namespace glint {
namespace {

using Rows = Eigen::Matrix<double, 6, k_motion_size>;

// The pose's six rows of F times `p`; `half` is the left Jacobian of the rotation `rotation`.
template <int Columns>
Eigen::Matrix<double, 6, Columns> propagated_pose_rows(
    const Eigen::Matrix<double, k_motion_size, Columns>& p, const SingerStep& linear,
    const SingerStep& angular, const Matrix3& rotation, const Matrix3& half) {
  using Three = Eigen::Matrix<double, 3, Columns>;
  const Three rotated_rows = rotation.lazyProduct(p.template middleRows<3>(k_rotation));
  const Three gathered =
      angular.seconds * p.template middleRows<3>(k_angular_velocity) +
      angular.position_by_acceleration * p.template middleRows<3>(k_angular_acceleration);
  Eigen::Matrix<double, 6, Columns> result;
  result.template topRows<3>() =
      p.template middleRows<3>(k_position) + linear.seconds * p.template middleRows<3>(k_velocity) +
      linear.position_by_acceleration * p.template middleRows<3>(k_acceleration);
  result.template bottomRows<3>() = rotated_rows + half.lazyProduct(gathered);
  return result;
}

}  // namespace

UncertainPose predict_pose(const MotionState& state, Time time, const MotionSettings& settings,
                           const NoiseScale& scale) noexcept {
  if (time <= state.time) return pose_of(state);
  const double seconds = (time - state.time).seconds();
  const SingerStep linear = singer_step(settings.linear_damping_1_s, seconds);
  const SingerStep angular = singer_step(settings.angular_damping_1_s, seconds);
  const Vector3 rotation_vector =
      angular.seconds * state.angular_velocity_rad_s +
      angular.position_by_acceleration * state.angular_acceleration_rad_s2;
  const Quaternion rotation = from_rotation_vector(rotation_vector);
  UncertainPose later{time, state.pose, {}};
  later.pose.translation += linear.seconds * state.velocity_m_s +
                            linear.position_by_acceleration * state.acceleration_m_s2;
  later.pose.rotation = (rotation * state.pose.rotation).normalized();

  const Matrix3 rotation_matrix = rotation.toRotationMatrix();
  const Matrix3 half = from_rotation_vector(0.5 * rotation_vector).toRotationMatrix();
  const Rows rows =
      propagated_pose_rows<k_motion_size>(state.covariance, linear, angular, rotation_matrix, half);
  later.covariance =
      propagated_pose_rows<6>(rows.transpose(), linear, angular, rotation_matrix, half);
  const double position_noise = scale.linear * settings.linear_noise_m2_s5 * linear.noise(0, 0);
  const double rotation_noise =
      scale.angular * settings.angular_noise_rad2_s5 * angular.noise(0, 0);
  for (int i = 0; i < 3; ++i) {
    later.covariance(i, i) += position_noise;
    later.covariance(3 + i, 3 + i) += rotation_noise;
  }
  later.covariance.topLeftCorner<3, 3>() += occlusion_covariance(
      state.velocity_m_s, linear_occlusion_share_1_s(state.velocity_m_s), seconds);
  later.covariance.bottomRightCorner<3, 3>() +=
      occlusion_covariance(state.angular_velocity_rad_s, k_angular_occlusion_share_1_s, seconds);
  return later;
}

}  // namespace glint
