// What frames 22 ms apart do not show of a hand: that a stroke ends, or turns back.
//
// What:     along its velocity v a tool gathers or loses share * |v| of speed a second, as chance
//           has it and for as long as nobody looks: after a time t its speed has spread by
//           share^2 t^2 v v', its place by share^2 t^4 / 4 v v'. Across v nothing.
//           The share of shifts grows with the speed, for a stroke ends within a hand's reach d:
//           to stop there takes v^2 / (2 d).
// Cost:     one outer product of three and one root a motion: 20 ns.
// Worst:    nothing depends on the input; at rest it adds nothing.
// Accuracy: along single steps the spread of speed is exact, that of place 2/3 of the whole's.
// Source:   the mechanism: in three of four recordings errors of 0.2 s ahead were 1.2 to 3 times as
//           large along the motion as across it. The shares: README.md, "Strokes".
#pragma once

#include <cmath>

#include "kernels/motion/motion_state.hpp"

namespace glint {

// The rms of that share, of slow shifts and of turns.
inline constexpr double k_linear_stroke_1_s = 0.9;
inline constexpr double k_angular_stroke_1_s = 2.0;
inline constexpr double k_stroke_reach_m = 0.4;

// Of shifts at this velocity.
[[nodiscard]] inline double linear_stroke_1_s(const Vector3& velocity_m_s) {
  constexpr double k_least = k_linear_stroke_1_s * k_linear_stroke_1_s;
  constexpr double k_per_speed = 1 / (2 * k_stroke_reach_m);
  return std::sqrt(k_least + k_per_speed * k_per_speed * velocity_m_s.squaredNorm());
}

// Of the place, or of the rotation, `seconds` after the velocity was known.
[[nodiscard]] inline Matrix3 stroke_spread(const Vector3& velocity, double share_1_s,
                                           double seconds) {
  const double moved = 0.5 * share_1_s * seconds * seconds;
  return (moved * velocity) * (moved * velocity).transpose();
}

// To a covariance that was propagated over the last `seconds` of the `hidden_s` since all of the
// tool was seen: what its first triple and the speed behind it gather.
inline void add_strokes(MotionCovariance& covariance, int place, const Vector3& velocity,
                        double share_1_s, double hidden_s, double seconds) {
  // White noise that brings the speed's spread from where it was to where it is.
  const double density = share_1_s * share_1_s * (2 * hidden_s - seconds);
  const Matrix3 noise = (density * velocity) * velocity.transpose();
  const int speed = place + 3;
  covariance.block<3, 3>(place, place) += (seconds * seconds * seconds / 3) * noise;
  covariance.block<3, 3>(place, speed) += (seconds * seconds / 2) * noise;
  covariance.block<3, 3>(speed, place) += (seconds * seconds / 2) * noise;
  covariance.block<3, 3>(speed, speed) += seconds * noise;
}

}  // namespace glint
