// Error-state Kalman filter of a hand-held tool's motion, for irregular time stamps.
//
// What:     propagate: mean and covariance to a later time under damped acceleration and damped
//           angular acceleration; correct: by a full pose, or by one marker if a prior exists.
// Cost:     propagate 2.5 us, correct by a pose 2.4 us, by a point less; no input-dependent loop.
// Worst:    data independent. An innovation covariance that is not positive definite leaves the
//           state unchanged, with Reason::degenerate.
// Accuracy: first order in the errors; second order for a single marker's position, because one
//           marker leaves rotation weakly observed. Rotation over a step exact for a constant axis.
// Source:   Singer 1970 (the damped acceleration); Bar-Shalom, Li and Kirubarajan 2001, section
//           5.2 (the filter's equations, as P - W'W with W = L^-1 H P, S = L L') and 10.3.2 (second
//           order); rotation error about fixed axes: Sola, Deray and Atchuthan 2018, A micro Lie
//           theory for state estimation in robotics; errors rotated with a marker's correction:
//           Barrau and Bonnabel 2017, The invariant extended Kalman filter as a stable observer.
#pragma once

#include "kernels/motion/motion_state.hpp"
#include "kernels/nonblocking.hpp"
#include "kernels/reason.hpp"

namespace glint {

// One setting for all motions of a hand; source of the figures: README.md, "Settings".
struct MotionSettings {
  double linear_noise_m2_s5 = 2.5;
  double linear_damping_1_s = 2.4;
  double angular_noise_rad2_s5 = 900;
  double angular_damping_1_s = 55;
  // Initial standard deviations of velocity and angular velocity, each axis.
  double start_speed_m_s = 1;
  double start_angular_speed_rad_s = 3.0;
};

// Factors on the settings' process noise, adapted from the innovations.
struct NoiseScale {
  double linear = 1;
  double angular = 1;
};

struct Correction {
  Reason reason = Reason::none;
  double nis = 0;                             // NIS of the complete innovation
  double linear_nis = 0;                      // NIS of its first three components alone
  double angular_nis = 0;                     // NIS of its last three alone; 0 for a point
  Vector3 linear_whitened = Vector3::Zero();  // its first three, whitened; 0 for a point
};

[[nodiscard]] MotionState initial_motion_state(
    const UncertainPose& first, const MotionSettings& settings) noexcept GLINT_NONBLOCKING;

// Propagates the state to `time`; an earlier time changes nothing.
void propagate(MotionState& state, Time time, const MotionSettings& settings,
               const NoiseScale& scale) noexcept GLINT_NONBLOCKING;

// F: transition of an error of `state` to `time`; the identity for an earlier time.
[[nodiscard]] MotionCovariance transition_to(
    const MotionState& state, Time time, const MotionSettings& settings) noexcept GLINT_NONBLOCKING;

// Corrects the state by an error, in the order of the error vector; leaves the covariance.
void add_error(MotionState& state, const MotionStateError& error) noexcept GLINT_NONBLOCKING;
// The error of b for which add_error(b, error) gives a.
[[nodiscard]] MotionStateError motion_difference(const MotionState& a,
                                                 const MotionState& b) noexcept GLINT_NONBLOCKING;

// Require a measurement of the state's own time. A non-positive innovation covariance returns
// Reason::degenerate and changes nothing.
[[nodiscard]] Correction correct_by_pose(MotionState& state,
                                         const UncertainPose& measured) noexcept GLINT_NONBLOCKING;
[[nodiscard]] Correction correct_by_point(MotionState& state,
                                          const MeasuredPoint& measured) noexcept GLINT_NONBLOCKING;

// Difference of two poses in fixed axes, order (x, y, z, rx, ry, rz), metres and radians. Its
// rotation part e: measured = Exp(e) * predicted.
[[nodiscard]] Vector6 pose_difference(const Pose& measured,
                                      const Pose& predicted) noexcept GLINT_NONBLOCKING;

// The state in a frame whose poses are `moved` times those of the state's own frame.
[[nodiscard]] MotionState transformed_state(const MotionState& state,
                                            const Pose& moved) noexcept GLINT_NONBLOCKING;

// The state's pose with its 6x6 marginal covariance.
[[nodiscard]] UncertainPose pose_of(const MotionState& state) noexcept GLINT_NONBLOCKING;

}  // namespace glint
