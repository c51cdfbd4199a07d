// Between two frames and a little beyond: constant velocity for position, SLERP for orientation.
//
// What:     the pose at a time, from two stamped poses; the velocities that take one to the other.
// Cost:     one arc tangent and two sines, 60 to 100 ns.
// Worst:    equal orientations, opposite quaternions, equal or backward stamps: all are defined.
// Accuracy: 4e-15 in the quaternion for any u in [-100, 100] times the arc.
// Source:   Shoemake 1985, Animating rotation with quaternion curves, section 3.3 (Slerp); the arc
//           from Kahan's 2 atan2(|a - b|, |a + b|), which keeps its digits near 0 and near pi.
#pragma once

#include "kernels/geometry.hpp"
#include "kernels/nonblocking.hpp"
#include "kernels/units.hpp"

namespace glint {

struct StampedPose {
  Time time;
  Pose pose;
};

// About fixed axes of the frame that the poses are given in.
struct Velocity {
  Vector3 linear_m_s = Vector3::Zero();
  Vector3 angular_rad_s = Vector3::Zero();
};

// p0 at u = 0, p1 at u = 1, on their line for every u.
[[nodiscard]] Vector3 constant_velocity(const Vector3& p0, const Vector3& p1,
                                        double u) noexcept GLINT_NONBLOCKING;

// q0 at u = 0, q1 at u = 1 (or its negative, the same rotation), along the shorter arc; outside
// [0, 1] it goes on at the same angular velocity. Both unit; |u| <= 1e4; so is the result.
[[nodiscard]] Quaternion slerp(const Quaternion& q0, const Quaternion& q1,
                               double u) noexcept GLINT_NONBLOCKING;

// From a to b; before a it is a, after b it is b. Stamps that do not rise: b.
[[nodiscard]] Pose interpolate(const StampedPose& a, const StampedPose& b,
                               Time t) noexcept GLINT_NONBLOCKING;

// Like interpolate, but goes on after b at the velocity from a to b, for max_horizon at most, and
// stays there. Stamps that do not rise: b.
[[nodiscard]] Pose extrapolate(const StampedPose& a, const StampedPose& b, Time t,
                               Duration max_horizon) noexcept GLINT_NONBLOCKING;

// Constant velocities that carry a to b. Stamps that do not rise: zero.
[[nodiscard]] Velocity velocity_between(const StampedPose& a,
                                        const StampedPose& b) noexcept GLINT_NONBLOCKING;

// Rotation vector (axis times angle, |angle| <= pi) of a unit quaternion, and back.
[[nodiscard]] Vector3 rotation_vector(const Quaternion& q) noexcept GLINT_NONBLOCKING;
[[nodiscard]] Quaternion from_rotation_vector(const Vector3& radians) noexcept GLINT_NONBLOCKING;

}  // namespace glint
