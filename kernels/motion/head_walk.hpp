// How the headset's own localisation errs: a random walk that returns to zero, faster and wider
// while the head moves.
//
// What:     the error is a shift and a small rotation about a pivot ahead of the camera, of the
//           declared deviations at rest and per speed. Over a time t it keeps the share exp(-t /
//           T), T between the two correlation times by their shares of the variance.
// Cost:     observe: one velocity and two exponentials; over: two exponentials and one covariance
//           moved to another point.
// Worst:    none is worse than another.
// Accuracy: as good as what is declared; the speed is smoothed as the error is.
// Source:   Ornstein and Uhlenbeck 1930, On the theory of the Brownian motion.
#pragma once

#include "kernels/motion/interpolate.hpp"
#include "kernels/nonblocking.hpp"
#include "kernels/pose/head_pose.hpp"

namespace glint {

// The headset's declared error: standard deviations of an axis, at a pivot ahead of the camera.
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
  double stamp_s = 0.005;  // of its poses against the frames: see world_errors.hpp
};

// What becomes of the error over a time, about one point of the world.
struct WalkedError {
  double kept = 0;                      // of the error before
  Matrix6 at_length = Matrix6::Zero();  // what its covariance grows to
  [[nodiscard]] Matrix6 fresh() const { return (1 - kept * kept) * at_length; }
};

class HeadWalk {
 public:
  // Each valid head, in the order of time. Seconds since the one before; of the first, more than
  // any correlation time.
  double observe(const HeadPose& head, const HeadNoise& noise) noexcept GLINT_NONBLOCKING;
  // At the newest head's place and speed.
  [[nodiscard]] WalkedError over(double seconds, const Vector3& point_m,
                                 const HeadNoise& noise) const noexcept GLINT_NONBLOCKING;
  // The stamps begin anew: the head's motion before does not count.
  void restart_clock() noexcept { has_head_ = false; }

 private:
  bool has_head_ = false;
  StampedPose head_;   // as the headset gave it
  Velocity velocity_;  // about the world's axes at the camera, smoothed over k_jitter_s
  double speed_m_s_ = 0, turn_rad_s_ = 0;  // its lengths, smoothed over motion_correlation_s
};

}  // namespace glint
