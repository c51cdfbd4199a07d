#include "kernels/motion/head_drift_correction.hpp"

#include <algorithm>

#include "kernels/elementary.hpp"
#include "kernels/motion/cholesky.hpp"
#include "kernels/motion/motion_filter.hpp"
#include "kernels/pose/lever_arm.hpp"

namespace glint {
namespace {

constexpr double k_likelihood_forgetting = 1 - 1.0 / 30;  // forgetting factor: 0.7 s at 45 Hz

// A translation and a rotation about `pivot`.
Pose motion_about(const Vector3& pivot, const Vector6& error) {
  const Quaternion rotation = from_rotation_vector(error.tail<3>());
  return {rotation, pivot + error.head<3>() - rotation * pivot};
}

}  // namespace

Matrix6 CorrectedHead::independent_at(const Vector3& point_m) const noexcept {
  return moved_covariance(independent, point_m - pivot_m);
}
Matrix6 CorrectedHead::shared_at(const Vector3& point_m) const noexcept {
  return moved_covariance(shared, point_m - pivot_m);
}

Matrix6 CorrectedHead::step_covariance_at(const Vector3& point_m) const noexcept {
  return moved_covariance(step_covariance, point_m - pivot_m);
}

Matrix6 HeadDriftCorrection::uncorrected_covariance_at(const Vector3& point_m) const noexcept {
  const double factor = drift_factor();
  return moved_covariance(factor * factor * transition_.stationary_covariance,
                          point_m - T_world_body_.translation);
}

Pose HeadDriftCorrection::corrected(const Pose& T_world_camera) const noexcept {
  return motion_about(T_world_body_.translation, filters_[best_].error).inverse() * T_world_camera;
}

void HeadDriftCorrection::propagate(const HeadPose& head, const HeadNoise& noise) {
  const double since = error_process_.observe(head, noise);
  if (!known()) T_world_body_.translation = head.T_world_camera * Vector3(0, 0, noise.pivot_m);
  transition_ = error_process_.transition_over(since, T_world_body_.translation, noise);
  const double kept = transition_.kept;
  for (std::size_t i = 0; i < filters_.size(); ++i) {
    FactorFilter& filter = filters_[i];
    filter.error *= kept;
    filter.covariance = kept * kept * filter.covariance +
                        k_drift_factors[i] * k_drift_factors[i] * transition_.added();
  }
}

// Running mean of the first measurements.
void HeadDriftCorrection::define_body_pose(const UncertainPose& T_world_body) {
  if (definition_count_ == 0) T_world_body_ = T_world_body.pose;
  ++definition_count_;
  const Vector6 off = pose_difference(T_world_body.pose, T_world_body_) / definition_count_;
  T_world_body_.translation += off.head<3>();
  T_world_body_.rotation =
      (from_rotation_vector(off.tail<3>()) * T_world_body_.rotation).normalized();
  filters_.fill(FactorFilter{});
}

HeadDriftCorrection::MeasurementUpdate HeadDriftCorrection::correct(
    const UncertainPose& T_world_body, FactorFilter& filter) const {
  MeasurementUpdate out{Matrix6::Zero(), filter.covariance};
  const Vector6 measured = pose_difference(T_world_body.pose, T_world_body_);
  const Vector6 innovation = measured - filter.error;
  const Cholesky<6> root(filter.covariance + T_world_body.covariance);
  const double chi_square =
      root.positive ? root.squared_length(innovation) : 2 * k_body_chi_square_max;
  // A rejected measurement counts with the limit, so it is never likelier than an accepted one.
  filter.log_likelihood *= k_likelihood_forgetting;
  filter.log_likelihood -= 0.5 * std::min(chi_square, k_body_chi_square_max);
  for (int i = 0; root.positive && i < 6; ++i) filter.log_likelihood -= logarithm(root.lower(i, i));
  if (chi_square <= k_body_chi_square_max) {
    const Matrix6 gain = filter.covariance.lazyProduct(root.inverse());
    const Matrix6 left = Matrix6::Identity() - gain;
    filter.error += gain * innovation;
    out.independent = gain.lazyProduct(T_world_body.covariance).lazyProduct(gain.transpose());
    out.shared = left.lazyProduct(filter.covariance).lazyProduct(left.transpose());
    out.accepted = true;
  } else if (++filter.refused >= k_body_rejected_max) {
    // A jump: reset the error to this measurement.
    filter.error = measured;
    out.independent = T_world_body.covariance;
    out.shared.setZero();
    out.accepted = out.jumped = true;
  }
  if (!out.accepted) return out;
  filter.refused = 0;
  const Matrix6 sum = out.independent + out.shared;
  filter.covariance = 0.5 * (sum + sum.transpose());
  return out;
}

void HeadDriftCorrection::correct_all(const UncertainPose& T_world_body, CorrectedHead& out) {
  std::array<MeasurementUpdate, k_drift_factors.size()> each;
  for (std::size_t i = 0; i < filters_.size(); ++i) each[i] = correct(T_world_body, filters_[i]);
  for (std::size_t i = 0; i < filters_.size(); ++i)
    if (filters_[i].log_likelihood > filters_[best_].log_likelihood) best_ = i;
  out.independent = each[best_].independent;
  out.shared = each[best_].shared;
  out.corrected = each[best_].accepted;
  jumps_ += each[best_].jumped ? 1 : 0;
}

CorrectedHead HeadDriftCorrection::update(const HeadPose& head, const UncertainPose* body,
                                          const HeadNoise& noise) noexcept {
  CorrectedHead out;
  out.head = head;
  if (!head.valid) return out;
  propagate(head, noise);

  const Pose before = motion_about(T_world_body_.translation, filters_[best_].error);
  out.shared = filters_[best_].covariance;
  if (body != nullptr) {
    const UncertainPose measured{
        head.time, head.T_world_camera * body->pose,
        rotated_covariance(body->covariance, head.T_world_camera.rotation)};
    if (definition_count_ < k_body_definition_frames) {
      define_body_pose(measured);
      out.shared.setZero();
      out.corrected = true;
    } else {
      correct_all(measured, out);
    }
  }
  out.moved_along = out.corrected && uncorrected_frames_ > 0;
  if (out.moved_along)
    out.gap_correction =
        motion_about(T_world_body_.translation, filters_[best_].error).inverse() * before;
  out.in_gap = uncorrected_frames_ > 0 || !out.corrected;
  if (out.in_gap) out.step_covariance = drift_factor() * drift_factor() * transition_.added();
  uncorrected_frames_ = out.corrected ? 0 : uncorrected_frames_ + 1;
  out.pivot_m = T_world_body_.translation;
  out.head.T_world_camera = corrected(head.T_world_camera);
  return out;
}

}  // namespace glint
