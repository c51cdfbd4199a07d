#include "kernels/motion/predict_motion.hpp"

#include "kernels/motion/interpolate.hpp"
#include "kernels/motion/singer.hpp"
#include "kernels/motion/stroke_noise.hpp"

namespace glint {
namespace {

using Rows = Eigen::Matrix<double, 6, k_motion_size>;

// The pose's six rows of F times `p`; `half` is the left Jacobian of the rotation `turn`.
template <int Columns>
Eigen::Matrix<double, 6, Columns> carried(const Eigen::Matrix<double, k_motion_size, Columns>& p,
                                          const SingerStep& linear, const SingerStep& angular,
                                          const Matrix3& turn, const Matrix3& half) {
  using Three = Eigen::Matrix<double, 3, Columns>;
  const Three turned = turn.lazyProduct(p.template middleRows<3>(k_rotation));
  const Three gathered =
      angular.seconds * p.template middleRows<3>(k_angular_velocity) +
      angular.place_by_acceleration * p.template middleRows<3>(k_angular_acceleration);
  Eigen::Matrix<double, 6, Columns> result;
  result.template topRows<3>() =
      p.template middleRows<3>(k_position) + linear.seconds * p.template middleRows<3>(k_velocity) +
      linear.place_by_acceleration * p.template middleRows<3>(k_acceleration);
  result.template bottomRows<3>() = turned + half.lazyProduct(gathered);
  return result;
}

}  // namespace

UncertainPose predict_pose(const MotionState& state, Time time, const MotionSettings& settings,
                           const NoiseScale& scale) noexcept {
  if (time <= state.time) return pose_of(state);
  const double seconds = (time - state.time).seconds();
  const SingerStep linear = singer_step(settings.linear_damping_1_s, seconds);
  const SingerStep angular = singer_step(settings.angular_damping_1_s, seconds);
  const Vector3 turn = angular.seconds * state.angular_velocity_rad_s +
                       angular.place_by_acceleration * state.angular_acceleration_rad_s2;
  const Quaternion turned = from_rotation_vector(turn);
  UncertainPose later{time, state.pose, {}};
  later.pose.translation +=
      linear.seconds * state.velocity_m_s + linear.place_by_acceleration * state.acceleration_m_s2;
  later.pose.rotation = (turned * state.pose.rotation).normalized();

  const Matrix3 whole = turned.toRotationMatrix();
  const Matrix3 half = from_rotation_vector(0.5 * turn).toRotationMatrix();
  const Rows rows = carried<k_motion_size>(state.covariance, linear, angular, whole, half);
  later.covariance = carried<6>(rows.transpose(), linear, angular, whole, half);
  const double place_noise = scale.linear * settings.linear_noise_m2_s5 * linear.noise(0, 0);
  const double turn_noise = scale.angular * settings.angular_noise_rad2_s5 * angular.noise(0, 0);
  for (int i = 0; i < 3; ++i) {
    later.covariance(i, i) += place_noise;
    later.covariance(3 + i, 3 + i) += turn_noise;
  }
  later.covariance.topLeftCorner<3, 3>() +=
      stroke_spread(state.velocity_m_s, linear_stroke_1_s(state.velocity_m_s), seconds);
  later.covariance.bottomRightCorner<3, 3>() +=
      stroke_spread(state.angular_velocity_rad_s, k_angular_stroke_1_s, seconds);
  return later;
}

}  // namespace glint
