// Process noise during occlusion, along the velocity: an unobserved hand may stop or reverse.
//
// Frames 22 ms apart do not show this noise.
//
// What:     a hidden tool accelerates along its velocity v at a constant random rate of rms
//           share * |v|. After a time t the velocity's covariance has grown by share^2 t^2 v v',
//           the position's by share^2 t^4 / 4 v v'; nothing is added across v. The share for
//           translation grows with the speed, because a hand stops within its reach d, which
//           takes a deceleration of v^2 / (2 d).
// Cost:     one outer product of three and one root a motion: 20 ns.
// Worst:    data independent; adds nothing at rest.
// Accuracy: added in steps, the velocity's covariance is exact and the position's is 2/3 of the
//           value for one step.
// Source:   the mechanism: in three of four recordings errors of predictions 0.2 s ahead were 1.2
//           to 3 times as large along the motion as across it. The shares:
//           README.md, "Process noise during occlusion".
#pragma once

#include <cmath>

#include "kernels/motion/motion_state.hpp"

namespace glint {

// Rms of the share, for slow translation and for rotation.
inline constexpr double k_linear_occlusion_share_1_s = 0.9;
inline constexpr double k_angular_occlusion_share_1_s = 2.0;
inline constexpr double k_hand_reach_m = 0.4;

// Rms of the share for translation at this velocity.
[[nodiscard]] inline double linear_occlusion_share_1_s(const Vector3& velocity_m_s) {
  constexpr double k_least = k_linear_occlusion_share_1_s * k_linear_occlusion_share_1_s;
  constexpr double k_per_speed = 1 / (2 * k_hand_reach_m);
  return std::sqrt(k_least + k_per_speed * k_per_speed * velocity_m_s.squaredNorm());
}

// Covariance added to position (or rotation) `seconds` after the last estimate of the velocity.
[[nodiscard]] inline Matrix3 occlusion_covariance(const Vector3& velocity, double share_1_s,
                                                  double seconds) {
  const double moved = 0.5 * share_1_s * seconds * seconds;
  return (moved * velocity) * (moved * velocity).transpose();
}

// Adds the noise of the last `seconds` to a covariance that was propagated over them. `hidden_s` is
// the time since the last full pose, `place` the first index of position or rotation.
inline void add_occlusion_noise(MotionCovariance& covariance, int place, const Vector3& velocity,
                                double share_1_s, double hidden_s, double seconds) {
  // White noise density that raises the velocity's covariance from its old to its new value.
  const double density = share_1_s * share_1_s * (2 * hidden_s - seconds);
  const Matrix3 noise = (density * velocity) * velocity.transpose();
  const int speed = place + 3;
  covariance.block<3, 3>(place, place) += (seconds * seconds * seconds / 3) * noise;
  covariance.block<3, 3>(place, speed) += (seconds * seconds / 2) * noise;
  covariance.block<3, 3>(speed, place) += (seconds * seconds / 2) * noise;
  covariance.block<3, 3>(speed, speed) += seconds * noise;
}

}  // namespace glint
