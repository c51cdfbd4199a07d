// Error model of the headset's localisation: a first-order Gauss-Markov process (Ornstein-
// Uhlenbeck) that is faster and larger while the head moves.
//
// What:     the error is a translation and a small rotation about a pivot ahead of the camera, with
//           declared standard deviations at rest and per speed. Over a time t it keeps the fraction
//           exp(-t / T), averaged over both correlation times T by their shares of the variance.
// Cost:     observe: one velocity and two exponentials; over: two exponentials and two covariances
//           moved to another point.
// Worst:    data independent.
// Accuracy: that of the declared values; the speed is smoothed over the error's correlation time.
// Source:   Ornstein and Uhlenbeck 1930, On the theory of the Brownian motion.
#pragma once

#include "kernels/motion/interpolate.hpp"
#include "kernels/nonblocking.hpp"
#include "kernels/pose/head_pose.hpp"

namespace glint {

// Declared localisation error: standard deviations of each axis, at a pivot ahead of the camera.
struct HeadNoise {
  double rest_position_m = 0.001;
  double rest_angle_rad = 0.002;
  double rest_correlation_s = 20;
  double position_per_speed_s = 0.03;  // m of error per m/s
  double position_per_turn_m = 0.01;   // m of error per rad/s
  double angle_per_speed_s_m = 0.02;   // rad of error per m/s
  double angle_per_turn_s = 0.02;      // rad of error per rad/s
  double motion_correlation_s = 0.4;
  double pivot_m = 0.5;
  double time_stamp_s = 0.005;  // time offset of head poses against frames: see world_errors.hpp
};

// Transition of the error over a time step, about one point of the world.
struct ErrorTransition {
  double kept = 0;                                  // fraction of the previous error
  Matrix6 stationary_covariance = Matrix6::Zero();  // stationary covariance
  [[nodiscard]] Matrix6 added() const { return (1 - kept * kept) * stationary_covariance; }
};

class HeadErrorProcess {
 public:
  // Requires each valid head pose, in order of time. Returns the seconds since the previous one;
  // for the first, a time longer than any correlation time.
  double observe(const HeadPose& head, const HeadNoise& noise) noexcept GLINT_NONBLOCKING;
  // The transition over `seconds` about `point_m`, at the newest head pose and speed.
  [[nodiscard]] ErrorTransition transition_over(double seconds, const Vector3& point_m,
                                                const HeadNoise& noise) const noexcept
      GLINT_NONBLOCKING;
  // Time stamps restart: discards the previous head pose.
  void restart_clock() noexcept { has_head_ = false; }

 private:
  bool has_head_ = false;
  TimedPose head_;     // as received from the headset
  Velocity velocity_;  // along the world's axes at the camera, smoothed over k_jitter_s
  double speed_m_s_ = 0, angular_speed_rad_s_ = 0;  // its norms, smoothed over motion_correlation_s
};

}  // namespace glint
