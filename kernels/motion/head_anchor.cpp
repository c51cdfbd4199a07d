#include "kernels/motion/head_anchor.hpp"

#include <algorithm>

#include "kernels/elementary.hpp"
#include "kernels/motion/cholesky.hpp"
#include "kernels/motion/motion_filter.hpp"
#include "kernels/pose/lever_arm.hpp"

namespace glint {
namespace {

// A shift and a rotation about `pivot`.
Pose motion_about(const Vector3& pivot, const Vector6& error) {
  const Quaternion turn = from_rotation_vector(error.tail<3>());
  return {turn, pivot + error.head<3>() - turn * pivot};
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

void HeadAnchor::walk_on(const HeadPose& head, const HeadNoise& noise) {
  const double since = walk_.observe(head, noise);
  if (!known()) T_world_body_.translation = head.T_world_camera * Vector3(0, 0, noise.pivot_m);
  const WalkedError walked = walk_.over(since, T_world_body_.translation, noise);
  error_ *= walked.kept;
  uncorrected_ = walked.at_length;
  step_ = walked.fresh();
  covariance_ = (walked.kept * walked.kept) * covariance_ + step_;
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
  walk_on(head, noise);

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
