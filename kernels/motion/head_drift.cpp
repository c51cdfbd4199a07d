#include "kernels/motion/head_drift.hpp"

#include <algorithm>

#include "kernels/elementary.hpp"
#include "kernels/pose/lever_arm.hpp"

namespace glint {
namespace {

constexpr double k_long_s = 1e6;    // longer than any correlation time
constexpr double k_jitter_s = 0.1;  // faster changes are jitter of the error

// Covariance at `lever` from the headset's pivot, for these standard deviations at the pivot.
Matrix6 moved_error_covariance(double position_m, double angle_rad, const Vector3& lever) {
  Matrix6 covariance = Matrix6::Zero();
  covariance.diagonal() << Vector3::Constant(position_m * position_m),
      Vector3::Constant(angle_rad * angle_rad);
  return moved_covariance(covariance, lever);
}

double decay_over(double seconds, double correlation_s) {
  return correlation_s > 0 ? exponential(-seconds / correlation_s) : 0;
}

}  // namespace

// The velocity is smoothed first: the error's jitter between two frames would appear as several
// times the headset's speed. Its norm is smoothed over the error's correlation time, because a head
// that moves back and forth has no mean velocity, but a speed.
double HeadErrorProcess::observe(const HeadPose& head, const HeadNoise& noise) noexcept {
  const TimedPose here{head.time, head.T_world_camera};
  const Velocity velocity = has_head_ ? velocity_between(head_, here) : Velocity{};
  const double seconds = has_head_ ? std::max((head.time - head_.time).seconds(), 0.0) : 0;
  const double smooth = 1 - decay_over(seconds, std::min(k_jitter_s, noise.motion_correlation_s));
  velocity_.linear_m_s += smooth * (velocity.linear_m_s - velocity_.linear_m_s);
  velocity_.angular_rad_s += smooth * (velocity.angular_rad_s - velocity_.angular_rad_s);
  const double follow = 1 - decay_over(seconds, noise.motion_correlation_s);
  speed_m_s_ += follow * (velocity_.linear_m_s.norm() - speed_m_s_);
  angular_speed_rad_s_ += follow * (velocity_.angular_rad_s.norm() - angular_speed_rad_s_);
  const double since = has_head_ ? seconds : k_long_s;
  has_head_ = true;
  head_ = here;
  return since;
}

ErrorTransition HeadErrorProcess::transition_over(double seconds, const Vector3& point_m,
                                                  const HeadNoise& noise) const noexcept {
  const Vector3 pivot = head_.pose * Vector3(0, 0, noise.pivot_m);
  const Vector3 lever = point_m - pivot;
  const double moving_position =
      noise.position_per_speed_s * speed_m_s_ + noise.position_per_turn_m * angular_speed_rad_s_;
  const double moving_angle =
      noise.angle_per_speed_s_m * speed_m_s_ + noise.angle_per_turn_s * angular_speed_rad_s_;
  const Matrix6 resting =
      moved_error_covariance(noise.rest_position_m, noise.rest_angle_rad, lever);
  const Matrix6 moving = moved_error_covariance(moving_position, moving_angle, lever);
  const double all = resting.trace() + moving.trace();
  const double share = all > 0 ? moving.trace() / all : 0;
  const double kept = share * decay_over(seconds, noise.motion_correlation_s) +
                      (1 - share) * decay_over(seconds, noise.rest_correlation_s);
  return {kept, resting + moving};
}

}  // namespace glint
