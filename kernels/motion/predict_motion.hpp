// Where a tool will be and how sure that is, from its motion state in closed form.
//
// What:     the pose after a time under damped accelerations, with the covariance that the state's
//           errors and the process noise have grown to by then. The plain reference of
//           integrate_motion.hpp, and what gives its poses their covariance.
// Cost:     two Singer steps, two rotations, 6 of the covariance's 18 rows.
// Worst:    nothing depends on the input; before the state's time it is the state's own pose.
// Accuracy: place exact; rotation too where angular velocity and acceleration share an axis,
//           otherwise off by |w x b| t^3 / 12 to first order (0.005 deg after 50 ms at 3 rad/s and
//           10 rad/s^2).
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
