#include "kernels/motion/interpolate.hpp"

#include <algorithm>
#include <cmath>

#include "kernels/elementary.hpp"

namespace glint {
namespace {

// Below this arc, rad, the sines' ratio equals u to rounding: its relative error is arc^2 / 6.
constexpr double k_small_arc = 1e-8;

double fraction(const TimedPose& a, const TimedPose& b, Time t) {
  return (t - a.time).seconds() / (b.time - a.time).seconds();
}

Pose between(const TimedPose& a, const TimedPose& b, double u) {
  return {slerp(a.pose.rotation, b.pose.rotation, u),
          constant_velocity(a.pose.translation, b.pose.translation, u)};
}

}  // namespace

Vector3 constant_velocity(const Vector3& p0, const Vector3& p1, double u) noexcept {
  return p0 + u * (p1 - p0);
}

Quaternion slerp(const Quaternion& q0, const Quaternion& q1, double u) noexcept {
  const Eigen::Vector4d a = q0.coeffs();
  const Eigen::Vector4d b = a.dot(q1.coeffs()) < 0 ? -q1.coeffs() : q1.coeffs();
  const Eigen::Vector4d difference = a - b;
  const Eigen::Vector4d sum = a + b;
  const double arc = 2.0 * arc_tangent(difference.norm(), sum.norm());  // at most pi/2
  double weight_a = 1.0 - u;
  double weight_b = u;
  if (arc > k_small_arc) {
    const double sine = sine_cosine(arc).sine;
    weight_a = sine_cosine((1.0 - u) * arc).sine / sine;
    weight_b = sine_cosine(u * arc).sine / sine;
  }
  const Eigen::Vector4d mixed = weight_a * a + weight_b * b;
  return Quaternion(mixed).normalized();
}

Pose interpolate(const TimedPose& a, const TimedPose& b, Time t) noexcept {
  if (b.time <= a.time) return b.pose;
  return between(a, b, std::clamp(fraction(a, b, t), 0.0, 1.0));
}

Pose extrapolate(const TimedPose& a, const TimedPose& b, Time t, Duration max_horizon) noexcept {
  if (b.time <= a.time) return b.pose;
  const Time last = b.time + std::max(max_horizon, Duration{});
  return between(a, b, std::max(fraction(a, b, std::min(t, last)), 0.0));
}

Velocity velocity_between(const TimedPose& a, const TimedPose& b) noexcept {
  Velocity velocity;
  if (b.time <= a.time) return velocity;
  const double gap = (b.time - a.time).seconds();
  velocity.linear_m_s = (b.pose.translation - a.pose.translation) / gap;
  velocity.angular_rad_s = rotation_vector(b.pose.rotation * a.pose.rotation.conjugate()) / gap;
  return velocity;
}

Vector3 rotation_vector(const Quaternion& q) noexcept {
  const double sine = q.vec().norm();
  if (sine <= 0) return Vector3::Zero();
  const double side = q.w() < 0 ? -1.0 : 1.0;
  const double angle = 2.0 * arc_tangent(sine, side * q.w());
  return q.vec() * (side * angle / sine);
}

Quaternion from_rotation_vector(const Vector3& radians) noexcept {
  const double angle = radians.norm();
  if (angle <= k_small_arc) {
    return Quaternion(1.0, 0.5 * radians.x(), 0.5 * radians.y(), 0.5 * radians.z()).normalized();
  }
  const SineCosine half = sine_cosine(0.5 * angle);
  const Vector3 v = radians * (half.sine / angle);
  return Quaternion(half.cosine, v.x(), v.y(), v.z()).normalized();
}

}  // namespace glint
