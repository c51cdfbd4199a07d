#include "kernels/motion/head_anchor.hpp"

#include <algorithm>

#include "kernels/elementary.hpp"
#include "kernels/motion/cholesky.hpp"
#include "kernels/motion/motion_filter.hpp"
#include "kernels/pose/lever_arm.hpp"

namespace glint {
namespace {

constexpr double k_long_s = 1e6;    // beyond any correlation
constexpr double k_jitter_s = 0.1;  // what is faster counts as the error's jitter

// A shift and a rotation about `pivot`.
Pose motion_about(const Vector3& pivot, const Vector6& error) {
  const Quaternion turn = from_rotation_vector(error.tail<3>());
  return {turn, pivot + error.head<3>() - turn * pivot};
}

// Of an error with these deviations about the headset's pivot, at `lever` from there.
Matrix6 spread(double position_m, double angle_rad, const Vector3& lever) {
  Matrix6 covariance = Matrix6::Zero();
  covariance.diagonal() << Vector3::Constant(position_m * position_m),
      Vector3::Constant(angle_rad * angle_rad);
  return moved_covariance(covariance, lever);
}

double kept_over(double seconds, double correlation_s) {
  return correlation_s > 0 ? exponential(-seconds / correlation_s) : 0;
}

}  // namespace

Matrix6 AnchoredHead::fresh_at(const Vector3& point_m) const noexcept {
  return moved_covariance(fresh, point_m - pivot_m);
}
Matrix6 AnchoredHead::lasting_at(const Vector3& point_m) const noexcept {
  return moved_covariance(lasting, point_m - pivot_m);
}

Matrix6 AnchoredHead::stepped_at(const Vector3& point_m) const noexcept {
  return moved_covariance(stepped, point_m - pivot_m);
}

Matrix6 HeadAnchor::uncorrected_at(const Vector3& point_m) const noexcept {
  return moved_covariance(uncorrected_, point_m - T_world_body_.translation);
}

Pose HeadAnchor::corrected(const Pose& T_world_camera) const noexcept {
  return motion_about(T_world_body_.translation, error_).inverse() * T_world_camera;
}

// The error's own jitter between two frames would count as speed, several times the headset's: the
// velocity is smoothed first. Its length is smoothed as the error itself is: a head that moves to
// and fro has no mean velocity, but a speed.
void HeadAnchor::observe_speed(const HeadPose& head, const HeadNoise& noise) {
  const StampedPose here{head.time, head.T_world_camera};
  const Velocity velocity = has_head_ ? velocity_between(head_, here) : Velocity{};
  const double seconds = has_head_ ? std::max((head.time - head_.time).seconds(), 0.0) : 0;
  const double smooth = 1 - kept_over(seconds, std::min(k_jitter_s, noise.motion_correlation_s));
  velocity_.linear_m_s += smooth * (velocity.linear_m_s - velocity_.linear_m_s);
  velocity_.angular_rad_s += smooth * (velocity.angular_rad_s - velocity_.angular_rad_s);
  const double follow = 1 - kept_over(seconds, noise.motion_correlation_s);
  speed_m_s_ += follow * (velocity_.linear_m_s.norm() - speed_m_s_);
  turn_rad_s_ += follow * (velocity_.angular_rad_s.norm() - turn_rad_s_);
}

void HeadAnchor::walk_on(const Pose& T_world_camera, double seconds, const HeadNoise& noise) {
  const Vector3 pivot = T_world_camera * Vector3(0, 0, noise.pivot_m);
  const Vector3 lever = T_world_body_.translation - pivot;
  const double moving_position =
      noise.position_per_speed_s * speed_m_s_ + noise.position_per_turn_m * turn_rad_s_;
  const double moving_angle =
      noise.angle_per_speed_s_m * speed_m_s_ + noise.angle_per_turn_s * turn_rad_s_;
  const Matrix6 resting = spread(noise.rest_position_m, noise.rest_angle_rad, lever);
  const Matrix6 moving = spread(moving_position, moving_angle, lever);
  const double all = resting.trace() + moving.trace();
  const double share = all > 0 ? moving.trace() / all : 0;
  const double kept = share * kept_over(seconds, noise.motion_correlation_s) +
                      (1 - share) * kept_over(seconds, noise.rest_correlation_s);
  error_ *= kept;
  uncorrected_ = resting + moving;
  step_ = (1 - kept * kept) * uncorrected_;
  covariance_ = (kept * kept) * covariance_ + step_;
}

// The mean of the first sights.
void HeadAnchor::define(const UncertainPose& T_world_body) {
  if (sights_ == 0) T_world_body_ = T_world_body.pose;
  ++sights_;
  const Vector6 off = pose_difference(T_world_body.pose, T_world_body_) / sights_;
  T_world_body_.translation += off.head<3>();
  T_world_body_.rotation =
      (from_rotation_vector(off.tail<3>()) * T_world_body_.rotation).normalized();
}

// False: this sight is none of the body where it is.
bool HeadAnchor::correct(const UncertainPose& T_world_body, AnchoredHead& out) {
  const Vector6 innovation = pose_difference(T_world_body.pose, T_world_body_) - error_;
  const Matrix6 sum = covariance_ + T_world_body.covariance;
  const Cholesky<6> factor(sum);
  if (!factor.positive || !(factor.squared_length(innovation) <= k_anchor_chi_square_max))
    return false;
  const Matrix6 gain = covariance_.lazyProduct(factor.inverse());
  const Matrix6 left = Matrix6::Identity() - gain;
  error_ += gain * innovation;
  out.fresh = gain.lazyProduct(T_world_body.covariance).lazyProduct(gain.transpose());
  out.lasting = left.lazyProduct(covariance_).lazyProduct(left.transpose());
  covariance_ = out.fresh + out.lasting;
  covariance_ = (0.5 * (covariance_ + covariance_.transpose())).eval();
  return true;
}

// As this sight has it, whatever was known before.
void HeadAnchor::take_over(const UncertainPose& T_world_body, AnchoredHead& out) {
  error_ = pose_difference(T_world_body.pose, T_world_body_);
  covariance_ = out.fresh = T_world_body.covariance;
  out.lasting.setZero();
}

AnchoredHead HeadAnchor::update(const HeadPose& head, const UncertainPose* body,
                                const HeadNoise& noise) noexcept {
  AnchoredHead out;
  out.head = head;
  if (!head.valid) return out;
  observe_speed(head, noise);
  if (!known()) T_world_body_.translation = head.T_world_camera * Vector3(0, 0, noise.pivot_m);
  // Of the first head nothing is known but what is declared.
  const double since = has_head_ ? (head.time - head_.time).seconds() : k_long_s;
  walk_on(head.T_world_camera, std::max(since, 0.0), noise);
  has_head_ = true;
  head_ = {head.time, head.T_world_camera};

  const Pose before = motion_about(T_world_body_.translation, error_);
  out.lasting = covariance_;
  if (body != nullptr) {
    const UncertainPose seen{head.time, head.T_world_camera * body->pose,
                             turned_covariance(body->covariance, head.T_world_camera.rotation)};
    out.corrected = true;
    if (sights_ < k_anchor_frames) {
      define(seen);
      error_.setZero();
      covariance_.setZero();
      out.lasting.setZero();
    } else if (correct(seen, out)) {
      refused_ = 0;
    } else if (++refused_ >= k_anchor_refused_max) {
      take_over(seen, out);
      refused_ = 0;
      ++jumps_;
    } else {
      out.corrected = false;
    }
  }
  out.moved_along = out.corrected && unseen_ > 0;
  if (out.moved_along)
    out.moved = motion_about(T_world_body_.translation, error_).inverse() * before;
  out.in_gap = unseen_ > 0 || !out.corrected;
  if (out.in_gap) out.stepped = step_;
  unseen_ = out.corrected ? 0 : unseen_ + 1;
  out.pivot_m = T_world_body_.translation;
  out.head.T_world_camera = corrected(head.T_world_camera);
  return out;
}

}  // namespace glint
