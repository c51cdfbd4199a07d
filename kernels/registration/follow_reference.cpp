#include "kernels/registration/follow_reference.hpp"

#include <algorithm>
#include <cmath>

#include "kernels/elementary.hpp"

namespace glint {
namespace {

// Rotation vector from b to a about fixed axes, radians.
Vector3 rotation_vector_between(const Quaternion& a, const Quaternion& b) noexcept {
  const Quaternion q = a * b.conjugate();
  const double sine = q.vec().norm();
  if (!(sine > 0)) return Vector3::Zero();
  const double angle = 2 * arc_tangent(sine, std::abs(q.w()));
  return q.vec() * ((q.w() < 0 ? -angle : angle) / sine);
}

// Per call: its fixed part.
constexpr int k_follow_call_steps = 200;

double sigma_of(const Matrix6& covariance, int first) noexcept {
  return std::sqrt(covariance(first, first) + covariance(first + 1, first + 1) +
                   covariance(first + 2, first + 2));
}

}  // namespace

const char* name_of(FollowOutcome outcome) noexcept {
  switch (outcome) {
    case FollowOutcome::followed:
      return "followed";
    case FollowOutcome::late:
      return "late";
    case FollowOutcome::hidden:
      return "hidden";
    case FollowOutcome::unexplained:
      return "unexplained";
    case FollowOutcome::unsure:
      return "unsure";
    case FollowOutcome::jumped:
      return "jumped";
    default:
      return "no_reference";
  }
}

Reason RobotPoseTracker::prepare(int pixels, int corners) {
  has_reference_ = false;
  phase_ = Phase::idle;
  for (const double value : {settings.time_constant_s, settings.jump_m, settings.jump_rad}) {
    if (!(value > 0) || !std::isfinite(value)) return Reason::out_of_range;
  }
  if (!(settings.drift_m_s >= 0) || !(settings.drift_rad_s >= 0)) return Reason::out_of_range;
  return scratch_.prepare(1, pixels, corners);
}

void RobotPoseTracker::begin(const Pose& T_world_base, const Matrix6& covariance,
                             Time time) noexcept {
  reference_ = {T_world_base, covariance, time};
  newest_ = time;
  report_ = FollowReport{};
  report_.time = time;
  report_.outcome = FollowOutcome::followed;
  phase_ = Phase::idle;
  has_reference_ = true;
}

bool RobotPoseTracker::look(const SceneView& view, Time time) noexcept {
  const int jumps = report_.jumps;
  report_ = FollowReport{};
  report_.time = time;
  report_.jumps = jumps;
  phase_ = Phase::idle;
  if (!has_reference_) return false;
  if (time <= newest_) {
    report_.outcome = FollowOutcome::late;
    return false;
  }
  newest_ = time;
  view_ = view;
  run_.start(reference_.T_world_base, settings.alignment);
  phase_ = Phase::align;
  return true;
}

int RobotPoseTracker::slices_max() const noexcept {
  return AlignmentRun::slices_max(settings.alignment, 1) + 1;
}

bool RobotPoseTracker::step() noexcept {
  if (phase_ == Phase::idle) return false;
  const std::span<const SceneView> views(&view_, 1);
  if (phase_ == Phase::align) {
    if (!run_.step(views, scratch_)) begin_judging();
    return true;
  }
  bool more = true;
  for (StepBudget all; more; all = StepBudget()) more = step(all);
  return false;
}

int RobotPoseTracker::step(int most_steps) noexcept {
  StepBudget budget(std::max(most_steps, 1));
  const int before = budget.left();
  bool more = !idle();
  while (more && !budget.spent()) more = step(budget);
  return before - budget.left();
}

// Requires an unspent budget, so that every call makes progress.
bool RobotPoseTracker::step(StepBudget& budget) noexcept {
  const std::span<const SceneView> views(&view_, 1);
  bool more = true;
  if (phase_ == Phase::align) {
    if (!run_.step(views, budget, scratch_)) begin_judging();
  } else if (judge_.step(views, budget, scratch_)) {
    report_.seen = run_.result();
    report_.judgement = judge_.result();
    decide();
    phase_ = Phase::idle;
    more = false;
  }
  budget.take(k_follow_call_steps);
  return more;
}

void RobotPoseTracker::begin_judging() noexcept {
  judge_.start(run_.result().T_world_base, settings.judge);
  phase_ = Phase::judge;
}

FollowOutcome RobotPoseTracker::outcome() const noexcept {
  const AlignmentScore& j = report_.judgement;
  if (report_.seen.reason != Reason::none || j.visible_share() < settings.visible_share_min) {
    return FollowOutcome::hidden;
  }
  if (j.inlier_share() < settings.inlier_share_min ||
      j.unhidden_seen_through_share() > settings.seen_through_share_max) {
    return FollowOutcome::unexplained;
  }
  // Three standard deviations of noise must not exceed the jump limits.
  if (3 * sigma_of(report_.seen.covariance, 0) > settings.jump_m ||
      3 * sigma_of(report_.seen.covariance, 3) > settings.jump_rad) {
    return FollowOutcome::unsure;
  }
  const bool far = report_.shift_m > settings.jump_m || report_.turn_rad > settings.jump_rad;
  return far ? FollowOutcome::jumped : FollowOutcome::followed;
}

void RobotPoseTracker::decide() noexcept {
  const Pose& was = reference_.T_world_base;
  const Pose& seen = report_.seen.T_world_base;
  const Vector3 centroid = run_.centroid();
  const Vector3 translation = seen * (was.inverse() * centroid) - centroid;
  const Vector3 rotation = rotation_vector_between(seen.rotation, was.rotation);
  report_.shift_m = translation.norm();
  report_.turn_rad = rotation.norm();
  report_.outcome = outcome();
  report_.jumps = report_.outcome == FollowOutcome::jumped ? report_.jumps + 1 : 0;
  if (report_.outcome != FollowOutcome::followed) return;
  const double passed = (report_.time - reference_.measured).seconds();
  const double gain = 1 - exponential(-std::min(passed / settings.time_constant_s, 700.0));
  reference_.T_world_base = moved(was, {gain * translation, gain * rotation}, centroid);
  reference_.covariance =
      (1 - gain) * (1 - gain) * reference_.covariance + gain * gain * report_.seen.covariance;
  reference_.measured = report_.time;
}

FollowedReference RobotPoseTracker::reference(Time now) const noexcept {
  FollowedReference out = reference_;
  const double late =
      settings.time_constant_s + std::max(0.0, (now - reference_.measured).seconds());
  const double translation = settings.drift_m_s * late, rotation = settings.drift_rad_s * late;
  for (int i = 0; i < 3; ++i) {
    out.covariance(i, i) += translation * translation;
    out.covariance(i + 3, i + 3) += rotation * rotation;
  }
  return out;
}

}  // namespace glint
