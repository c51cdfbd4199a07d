// An error-state Kalman filter of a hand-held tool, between stamps that come as they come.
//
// What:     propagate: mean and covariance to a later time under damped acceleration and damped
//           angular acceleration; correct: by a full pose, or by one marker where a prior exists.
// Cost:     propagate 2.5 us, correct by a pose 2.4 us, by a point less; no input-dependent loop.
// Worst:    nothing depends on the input. A covariance that is not positive leaves the state as it
//           was, with Reason::degenerate.
// Accuracy: first order in the errors, a single marker's place second: a tool that one marker holds
//           may turn far. Rotation over a step exact for a constant axis.
// Source:   Singer 1970 (the damped acceleration); Bar-Shalom, Li and Kirubarajan 2001, section
//           5.2 (the filter's equations, as P - W'W with W = L^-1 H P, S = L L') and 10.3.2 (second
//           order); error of rotation about fixed axes: Sola, Deray and Atchuthan 2018, A micro Lie
//           theory for state estimation in robotics; errors that turn with what a marker corrects:
//           Barrau and Bonnabel 2017, The invariant extended Kalman filter as a stable observer.
#pragma once

#include "kernels/motion/motion_state.hpp"
#include "kernels/nonblocking.hpp"
#include "kernels/reason.hpp"

namespace glint {

// One setting for everything a hand does; where the figures come from: README.md, "The setting".
struct MotionSettings {
  double linear_noise_m2_s5 = 2.5;
  double linear_damping_1_s = 2.4;
  double angular_noise_rad2_s5 = 900;
  double angular_damping_1_s = 55;
  // At the start: how fast a hand may already be.
  double start_speed_m_s = 0.5;
  double start_turn_rad_s = 3.0;
};

// By how much the process noise differs from the settings', as the innovations have it.
struct NoiseScale {
  double linear = 1;
  double angular = 1;
};

struct Correction {
  Reason reason = Reason::none;
  double chi_square = 0;                      // of the whole innovation
  double linear_chi_square = 0;               // of its first three, alone
  double angular_chi_square = 0;              // of its last three, alone; 0 for a point
  Vector3 linear_whitened = Vector3::Zero();  // its first three, of unit variance; 0 for a point
};

[[nodiscard]] MotionState start_motion(const UncertainPose& first,
                                       const MotionSettings& settings) noexcept GLINT_NONBLOCKING;

// To `time`; not backwards: an earlier time changes nothing.
void propagate(MotionState& state, Time time, const MotionSettings& settings,
               const NoiseScale& scale) noexcept GLINT_NONBLOCKING;

// Both measurements are of the state's own time.
[[nodiscard]] Correction correct_by_pose(MotionState& state,
                                         const UncertainPose& measured) noexcept GLINT_NONBLOCKING;
[[nodiscard]] Correction correct_by_point(MotionState& state,
                                          const MeasuredPoint& measured) noexcept GLINT_NONBLOCKING;

// What a rotation's error is, in fixed axes: measured = Exp(error) * predicted.
[[nodiscard]] Vector6 pose_difference(const Pose& measured,
                                      const Pose& predicted) noexcept GLINT_NONBLOCKING;

// In a frame whose poses are `moved` times those of the state's own.
[[nodiscard]] MotionState moved_state(const MotionState& state,
                                      const Pose& moved) noexcept GLINT_NONBLOCKING;

// The state's pose with its share of the covariance.
[[nodiscard]] UncertainPose pose_of(const MotionState& state) noexcept GLINT_NONBLOCKING;

}  // namespace glint
