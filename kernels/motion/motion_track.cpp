#include "kernels/motion/motion_track.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "kernels/motion/cholesky.hpp"
#include "kernels/motion/occlusion_noise.hpp"

namespace glint {
namespace {

constexpr double k_point_axes = 3;
constexpr double k_distance_max_m = 1000;
constexpr double k_variance_max = 1e6;
constexpr double k_unit_tolerance = 1e-6;

// The settings give the factors' time constants in frames of 45 Hz. At 5 Hz a frame's innovation is
// nearly all motion and carries more information, at most that of four frames. Among 1, 2, 3, 4 and
// 9, four makes the worst of four recordings at 5 Hz most consistent, without harm to the others.
constexpr double k_frame_s = 0.022222222;
constexpr double k_frames_max = 4;

// Updates one factor by one innovation; the mean of the NIS is the number of axes.
double moved(double scale, double chi_square, double frames, const AdaptationSettings& settings) {
  const double ratio = std::min(chi_square / k_point_axes, settings.nis_ratio_max);
  return std::clamp(scale * (1 + (ratio - 1) * frames / settings.frames), settings.floor,
                    settings.ceiling);
}

// Successive innovations are uncorrelated if the split between motion and inflation is right. Too
// large an inflation absorbs motion that the velocity should follow: they correlate positively.
double updated_by_correlation(double scale, double correlation, double frames,
                              const AdaptationSettings& settings) {
  const double most = settings.nis_ratio_max;
  const double step = std::clamp(correlation, -most, most) * frames / settings.frames;
  return std::clamp(scale * (1 - step), settings.floor, settings.ceiling);
}

void add_pose_covariance(const Matrix6& added, MotionCovariance& covariance) {
  for (const auto& [row, from] : {std::pair{k_position, 0}, {k_rotation, 3}}) {
    for (const auto& [column, to] : {std::pair{k_position, 0}, {k_rotation, 3}})
      covariance.block<3, 3>(row, column) += added.block<3, 3>(from, to);
  }
}

// Quantile 1 - 1e-4 for 3 degrees of freedom.
constexpr double k_manoeuvre_chi_square = 21.11;

// Innovation of the position in standard deviations.
Vector3 whitened_innovation(const UncertainPose& measured, const MotionState& state) {
  const Matrix3 expected = state.covariance.block<3, 3>(k_position, k_position) +
                           measured.covariance.topLeftCorner<3, 3>();
  return Cholesky<3>(expected).forward(measured.pose.translation - state.pose.translation);
}

// A position innovation that fails the chi-square test is a manoeuvre: velocity and acceleration
// differ from the model by more than their covariance states. Scales the covariance of the
// translation so that the NIS becomes its mean. Without it, predictions at 5 Hz are off by ten
// stated sigmas where a hand starts or stops between two frames.
// Source: Zhou and Frank 1996, Strong tracking filtering of nonlinear time-varying stochastic
// systems (the fading factor).
void admit_manoeuvre(double nis, MotionState& state) {
  constexpr int k_translation_rows = 9;
  if (!(nis > k_manoeuvre_chi_square)) return;
  const double factor = std::sqrt(nis / k_point_axes);
  state.covariance.middleRows<k_translation_rows>(k_position) *= factor;
  state.covariance.middleCols<k_translation_rows>(k_position) *= factor;
}

// Finite, within the distance limit, a unit quaternion, and a positive definite covariance.
bool usable(const UncertainPose& measured) {
  const bool pose = measured.pose.translation.norm() <= k_distance_max_m &&
                    std::abs(measured.pose.rotation.norm() - 1) <= k_unit_tolerance;
  return pose && measured.covariance.trace() <= k_variance_max &&
         Cholesky<6>(measured.covariance).positive;
}

}  // namespace

Reason MotionTrack::stamp(Time time) const {
  if (!known_ || time > state_.time) return Reason::none;
  return time == state_.time ? Reason::frame_duplicate : Reason::frame_late;
}

MotionUpdate MotionTrack::update(const UncertainPose& measured, const CorrelatedErrors& correlated,
                                 const ToolMotionSettings& settings,
                                 StaticWindowSums& sums) noexcept {
  MotionUpdate done{stamp(measured.time), 0};
  if (done.reason == Reason::none && !usable(measured)) done.reason = Reason::out_of_range;
  if (done.reason != Reason::none) return done;
  if (known_ && measured.time - state_.time > settings.gap_max) reset();
  const double inflated = inflation_.topLeftCorner<3, 3>().trace();
  inflation_.setZero();
  done.static_tests = rest_.add(measured, correlated, settings.rest, sums);
  double frames = 1, motion_fraction = 1, linear_nis = 0;
  if (known_) {
    frames = std::min((measured.time - state_.time).seconds() / k_frame_s, k_frames_max);
    propagate(state_, measured.time, settings.motion, scale_);
    const double expected = state_.covariance.block<3, 3>(k_position, k_position).trace() +
                            measured.covariance.topLeftCorner<3, 3>().trace();
    const Vector3 whitened = whitened_innovation(measured, state_);
    linear_nis = whitened.squaredNorm();
    // A step of the headset's error is no manoeuvre: inflation_scale_ follows it.
    if (!(inflated > 0)) admit_manoeuvre(linear_nis, state_);
    correction_ = correct_by_pose(state_, measured);
    const double share = inflated / expected;
    const double along = whitened.dot(innovation_) / k_point_axes;
    inflation_scale_ =
        updated_by_correlation(inflation_scale_, share * along, frames, settings.inflation);
    innovation_ = whitened;
    motion_fraction = 1 - share;
  }
  if (!known_ || correction_.reason != Reason::none) {
    // First pose, or a covariance that rounding made indefinite.
    known_ = true;
    state_ = initial_motion_state(measured, settings.motion);
    scale_ = peak_scale_ = {};
    correction_ = {};
    inflation_scale_ = 1;
    innovation_.setZero();
    last_pose_time_ = measured.time;
    return done;
  }
  // The share of the innovation that the inflation explains carries no information on the motion.
  scale_.linear = moved(scale_.linear, linear_nis, motion_fraction * frames, settings.linear);
  scale_.angular = moved(scale_.angular, correction_.angular_nis, frames, settings.angular);
  last_pose_time_ = measured.time;
  const double decay = 1 - 1 / settings.peak_scale_frames;
  peak_scale_.linear = std::max(scale_.linear, decay * peak_scale_.linear);
  peak_scale_.angular = std::max(scale_.angular, decay * peak_scale_.angular);
  return done;
}

Reason MotionTrack::update(Time time, std::span<const MeasuredPoint> points,
                           const ToolMotionSettings& settings,
                           const StaticWindowSums& sums) noexcept {
  const Reason reason = stamp(time);
  if (reason != Reason::none) return reason;
  if (!known_ || time - state_.time > settings.gap_max || points.empty())
    return Reason::too_few_markers;
  // Single markers cannot enter the static window: the filter continues from the window's mean.
  MotionState next = estimate(sums);
  // Re-apply the covariance inflation added since the newest pose; the window's mean does not
  // contain it.
  if (is_static()) add_pose_covariance(inflation_, next.covariance);
  const double seconds = (time - next.time).seconds();
  const double hidden_s = (time - last_pose_time_).seconds();
  propagate(next, time, settings.motion, partial_visibility_noise_scale(settings));
  add_occlusion_noise(next.covariance, k_position, next.velocity_m_s,
                      linear_occlusion_share_1_s(next.velocity_m_s), hidden_s, seconds);
  add_occlusion_noise(next.covariance, k_rotation, next.angular_velocity_rad_s,
                      k_angular_occlusion_share_1_s, hidden_s, seconds);
  const std::size_t count = std::min(points.size(), k_points_max);
  for (std::size_t i = 0; i < count; ++i) {
    correction_ = correct_by_point(next, points[i]);
    if (correction_.reason != Reason::none || !std::isfinite(correction_.nis))
      return Reason::out_of_range;
  }
  state_ = next;
  rest_.clear();
  return Reason::none;
}

void MotionTrack::reset() noexcept {
  known_ = false;
  scale_ = peak_scale_ = {};
  rest_.clear();
}

void MotionTrack::move(const Pose& moved) noexcept {
  state_ = transformed_state(state_, moved);
  rest_.move(moved);
}

void MotionTrack::inflate_covariance(const Matrix6& covariance) noexcept {
  add_pose_covariance(inflation_scale_ * covariance, state_.covariance);
  inflation_ += inflation_scale_ * covariance;
}

Matrix6 MotionTrack::correlated_covariance(const StaticWindowSums& sums) const noexcept {
  return rest_.correlated(sums);
}

MotionState MotionTrack::estimate(const StaticWindowSums& sums) const noexcept {
  if (!known_ || !is_static()) return state_;
  const StaticEstimate rest = rest_.rest(sums);
  MotionState state;
  state.time = state_.time;
  state.pose = rest.pose.pose;
  state.velocity_m_s = rest.drift_per_s.head<3>();
  state.angular_velocity_rad_s = rest.drift_per_s.tail<3>();
  MotionCovariance& p = state.covariance;
  for (const auto& [row, from] : {std::pair{k_position, 0}, {k_rotation, 3}}) {
    for (const auto& [column, to] : {std::pair{k_position, 0}, {k_rotation, 3}})
      p.block<3, 3>(row, column) = rest.pose.covariance.block<3, 3>(from, to);
    p.block<3, 3>(row + 3, row + 3) = rest.drift_covariance.block<3, 3>(from, from);
    // The tool may start to move at any time.
    p.block<3, 3>(row + 6, row + 6) = state_.covariance.block<3, 3>(row + 6, row + 6);
  }
  return state;
}

}  // namespace glint
