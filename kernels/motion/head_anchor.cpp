#include "kernels/motion/head_anchor.hpp"

#include <algorithm>

#include "kernels/elementary.hpp"
#include "kernels/motion/cholesky.hpp"
#include "kernels/motion/motion_filter.hpp"
#include "kernels/pose/lever_arm.hpp"

namespace glint {
namespace {

constexpr double k_likelihood_kept = 1 - 1.0 / 30;  // forgetting factor: 0.7 s at 45 Hz

// A translation and a rotation about `pivot`.
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
  const double factor = drift_factor();
  return moved_covariance(factor * factor * walked_.at_length, point_m - T_world_body_.translation);
}

Pose HeadAnchor::corrected(const Pose& T_world_camera) const noexcept {
  return motion_about(T_world_body_.translation, held_[best_].error).inverse() * T_world_camera;
}

void HeadAnchor::walk_on(const HeadPose& head, const HeadNoise& noise) {
  const double since = walk_.observe(head, noise);
  if (!known()) T_world_body_.translation = head.T_world_camera * Vector3(0, 0, noise.pivot_m);
  walked_ = walk_.over(since, T_world_body_.translation, noise);
  const double kept = walked_.kept;
  for (std::size_t i = 0; i < held_.size(); ++i) {
    Held& held = held_[i];
    held.error *= kept;
    held.covariance =
        kept * kept * held.covariance + k_drift_factors[i] * k_drift_factors[i] * walked_.fresh();
  }
}

// Running mean of the first measurements.
void HeadAnchor::define(const UncertainPose& T_world_body) {
  if (sights_ == 0) T_world_body_ = T_world_body.pose;
  ++sights_;
  const Vector6 off = pose_difference(T_world_body.pose, T_world_body_) / sights_;
  T_world_body_.translation += off.head<3>();
  T_world_body_.rotation =
      (from_rotation_vector(off.tail<3>()) * T_world_body_.rotation).normalized();
  held_.fill(Held{});
}

HeadAnchor::Corrected HeadAnchor::correct(const UncertainPose& T_world_body, Held& held) const {
  Corrected out{Matrix6::Zero(), held.covariance};
  const Vector6 seen = pose_difference(T_world_body.pose, T_world_body_);
  const Vector6 innovation = seen - held.error;
  const Cholesky<6> root(held.covariance + T_world_body.covariance);
  const double chi_square =
      root.positive ? root.squared_length(innovation) : 2 * k_anchor_chi_square_max;
  // A rejected measurement counts with the limit, so it is never likelier than an accepted one.
  held.log_likelihood *= k_likelihood_kept;
  held.log_likelihood -= 0.5 * std::min(chi_square, k_anchor_chi_square_max);
  for (int i = 0; root.positive && i < 6; ++i) held.log_likelihood -= logarithm(root.lower(i, i));
  if (chi_square <= k_anchor_chi_square_max) {
    const Matrix6 gain = held.covariance.lazyProduct(root.inverse());
    const Matrix6 left = Matrix6::Identity() - gain;
    held.error += gain * innovation;
    out.fresh = gain.lazyProduct(T_world_body.covariance).lazyProduct(gain.transpose());
    out.lasting = left.lazyProduct(held.covariance).lazyProduct(left.transpose());
    out.accepted = true;
  } else if (++held.refused >= k_anchor_refused_max) {
    // A jump: reset the error to this measurement.
    held.error = seen;
    out.fresh = T_world_body.covariance;
    out.lasting.setZero();
    out.accepted = out.jumped = true;
  }
  if (!out.accepted) return out;
  held.refused = 0;
  const Matrix6 sum = out.fresh + out.lasting;
  held.covariance = 0.5 * (sum + sum.transpose());
  return out;
}

void HeadAnchor::correct_all(const UncertainPose& T_world_body, AnchoredHead& out) {
  std::array<Corrected, k_drift_factors.size()> each;
  for (std::size_t i = 0; i < held_.size(); ++i) each[i] = correct(T_world_body, held_[i]);
  for (std::size_t i = 0; i < held_.size(); ++i)
    if (held_[i].log_likelihood > held_[best_].log_likelihood) best_ = i;
  out.fresh = each[best_].fresh;
  out.lasting = each[best_].lasting;
  out.corrected = each[best_].accepted;
  jumps_ += each[best_].jumped ? 1 : 0;
}

AnchoredHead HeadAnchor::update(const HeadPose& head, const UncertainPose* body,
                                const HeadNoise& noise) noexcept {
  AnchoredHead out;
  out.head = head;
  if (!head.valid) return out;
  walk_on(head, noise);

  const Pose before = motion_about(T_world_body_.translation, held_[best_].error);
  out.lasting = held_[best_].covariance;
  if (body != nullptr) {
    const UncertainPose seen{head.time, head.T_world_camera * body->pose,
                             turned_covariance(body->covariance, head.T_world_camera.rotation)};
    if (sights_ < k_anchor_frames) {
      define(seen);
      out.lasting.setZero();
      out.corrected = true;
    } else {
      correct_all(seen, out);
    }
  }
  out.moved_along = out.corrected && unseen_ > 0;
  if (out.moved_along)
    out.moved = motion_about(T_world_body_.translation, held_[best_].error).inverse() * before;
  out.in_gap = unseen_ > 0 || !out.corrected;
  if (out.in_gap) out.stepped = drift_factor() * drift_factor() * walked_.fresh();
  unseen_ = out.corrected ? 0 : unseen_ + 1;
  out.pivot_m = T_world_body_.translation;
  out.head.T_world_camera = corrected(head.T_world_camera);
  return out;
}

}  // namespace glint
