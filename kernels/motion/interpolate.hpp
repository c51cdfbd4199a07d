// Pose interpolation and extrapolation: constant velocity for position, SLERP for orientation.
//
// What:     the pose at a time from two poses with time stamps; the velocities between them.
// Cost:     one arc tangent and two sines, 60 to 100 ns.
// Worst:    equal orientations, opposite quaternions, equal or decreasing time stamps: all defined.
// Accuracy: 4e-15 in the quaternion for any u in [-100, 100] times the arc.
// Source:   Shoemake 1985, Animating rotation with quaternion curves, section 3.3 (Slerp); the arc
//           by Kahan's 2 atan2(|a - b|, |a + b|), which is accurate near 0 and near pi.
#pragma once

#include "kernels/geometry.hpp"
#include "kernels/nonblocking.hpp"
#include "kernels/units.hpp"

namespace glint {

struct TimedPose {
  Time time;
  Pose pose;
};

// Along the fixed axes of the poses' parent frame.
struct Velocity {
  Vector3 linear_m_s = Vector3::Zero();
  Vector3 angular_rad_s = Vector3::Zero();
};

// Linear interpolation: p0 at u = 0, p1 at u = 1, extrapolated for any other u.
[[nodiscard]] Vector3 constant_velocity(const Vector3& p0, const Vector3& p1,
                                        double u) noexcept GLINT_NONBLOCKING;

// SLERP along the shorter arc: q0 at u = 0, q1 at u = 1 (or its negative, the same rotation);
// outside [0, 1] at the same angular velocity. Requires unit quaternions and |u| <= 1e4; returns a
// unit quaternion.
[[nodiscard]] Quaternion slerp(const Quaternion& q0, const Quaternion& q1,
                               double u) noexcept GLINT_NONBLOCKING;

// Interpolates from a to b, clamped to both ends. Returns b if b.time <= a.time.
[[nodiscard]] Pose interpolate(const TimedPose& a, const TimedPose& b,
                               Time t) noexcept GLINT_NONBLOCKING;

// Like interpolate, but extrapolates after b at the velocity from a to b, for at most max_horizon;
// holds the pose after that. Returns b if b.time <= a.time.
[[nodiscard]] Pose extrapolate(const TimedPose& a, const TimedPose& b, Time t,
                               Duration max_horizon) noexcept GLINT_NONBLOCKING;

// Constant velocities that move a to b. Returns zero if b.time <= a.time.
[[nodiscard]] Velocity velocity_between(const TimedPose& a,
                                        const TimedPose& b) noexcept GLINT_NONBLOCKING;

// Rotation vector (axis times angle, |angle| <= pi) of a unit quaternion, and back.
[[nodiscard]] Vector3 rotation_vector(const Quaternion& q) noexcept GLINT_NONBLOCKING;
[[nodiscard]] Quaternion from_rotation_vector(const Vector3& radians) noexcept GLINT_NONBLOCKING;

}  // namespace glint
