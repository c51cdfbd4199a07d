// Closed-form prediction of a tool's pose and its covariance from a motion state.
//
// What:     the pose after a time under damped accelerations; its covariance from the state's
//           errors, the process noise and that of occlusion_noise.hpp. The reference implementation
//           of integrate_motion.hpp, and the source of its poses' covariance.
// Cost:     two Singer steps, two rotations, 6 of the covariance's 18 rows.
// Worst:    data independent; until the state's time it returns the state's own pose.
// Accuracy: position exact; rotation exact if angular velocity w and acceleration b share an axis,
//           otherwise its error is |w x b| t^3 / 12 to first order (0.005 deg after 50 ms at
//           3 rad/s and 10 rad/s^2).
// Source:   Singer 1970 for the transition; Magnus 1954 for the rotation's error.
#pragma once

#include "kernels/motion/motion_filter.hpp"
#include "kernels/motion/motion_state.hpp"
#include "kernels/nonblocking.hpp"

namespace glint {

[[nodiscard]] UncertainPose predict_pose(const MotionState& state, Time time,
                                         const MotionSettings& settings,
                                         const NoiseScale& scale) noexcept GLINT_NONBLOCKING;

}  // namespace glint
