// Random motion states and measurements of them.
#pragma once

#include "kernels/motion/motion_filter.hpp"
#include "tests/unit/kernels/pose/scene.hpp"

namespace glint::test {

template <int N>
Eigen::Matrix<double, N, N> random_covariance(Random& random, double sigma) {
  Eigen::Matrix<double, N, N> root;
  for (int i = 0; i < N * N; ++i) root(i % N, i / N) = sigma * random.normal();
  return root * root.transpose() + 0.01 * sigma * sigma * Eigen::Matrix<double, N, N>::Identity();
}

inline MotionState random_state(Random& random) {
  MotionState state;
  state.pose = {random.rotation(), random.vector(0.3)};
  state.velocity_m_s = random.vector(0.5);
  state.acceleration_m_s2 = random.vector(3);
  state.angular_velocity_rad_s = random.vector(2);
  state.angular_acceleration_rad_s2 = random.vector(5);
  state.covariance = random_covariance<k_motion_size>(random, 0.01);
  return state;
}

// The state displaced by small errors, in the order of its covariance.
inline MotionState moved(const MotionState& state, const Eigen::Matrix<double, 18, 1>& error) {
  MotionState result = state;
  result.pose.translation += error.segment<3>(k_position);
  result.velocity_m_s += error.segment<3>(k_velocity);
  result.acceleration_m_s2 += error.segment<3>(k_acceleration);
  result.pose.rotation =
      (from_rotation_vector(error.segment<3>(k_rotation)) * state.pose.rotation).normalized();
  result.angular_velocity_rad_s += error.segment<3>(k_angular_velocity);
  result.angular_acceleration_rad_s2 += error.segment<3>(k_angular_acceleration);
  return result;
}

// The error that displaces `from` to `to`.
inline Eigen::Matrix<double, 18, 1> error_between(const MotionState& to, const MotionState& from) {
  Eigen::Matrix<double, 18, 1> error;
  error << to.pose.translation - from.pose.translation, to.velocity_m_s - from.velocity_m_s,
      to.acceleration_m_s2 - from.acceleration_m_s2,
      rotation_vector(to.pose.rotation * from.pose.rotation.conjugate()),
      to.angular_velocity_rad_s - from.angular_velocity_rad_s,
      to.angular_acceleration_rad_s2 - from.angular_acceleration_rad_s2;
  return error;
}

// A measurement of the true pose with this noise.
inline UncertainPose measured_pose(const Pose& truth, Time time, double position_sigma_m,
                                   double rotation_sigma_rad, Random& random) {
  UncertainPose measured;
  measured.time = time;
  measured.pose.translation = truth.translation + random.vector(position_sigma_m);
  measured.pose.rotation =
      (from_rotation_vector(random.vector(rotation_sigma_rad)) * truth.rotation).normalized();
  measured.covariance.diagonal() << Vector3::Constant(position_sigma_m * position_sigma_m),
      Vector3::Constant(rotation_sigma_rad * rotation_sigma_rad);
  return measured;
}

inline constexpr Time frame_time(int frame) { return Time{22'222'222LL * frame}; }

inline void add_bits(BitHash& hash, const MotionState& state) {
  hash.add(state.pose);
  for (int i = 0; i < 3; ++i) hash.add(state.velocity_m_s(i));
  for (int i = 0; i < 3; ++i) hash.add(state.angular_velocity_rad_s(i));
  for (int i = 0; i < k_motion_size; ++i) hash.add(state.covariance(i, (7 * i) % k_motion_size));
}

}  // namespace glint::test
