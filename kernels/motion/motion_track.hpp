// Motion estimate of one tool: adaptive Kalman filter in motion, mean of a static window at rest.
//
// What:     a Kalman filter under damped accelerations; the innovations scale its process noise,
//           not below a floor. While the static detector fires, the estimate is the static window's
//           mean and drift (zero unless its halves differ). A factor scales the covariance that
//           inflate_covariance() adds; it follows the correlation of successive innovations.
// Cost:     propagate + correct + static window: 11 us a measured pose.
// Worst:    a full static window; otherwise data independent.
// Accuracy: by simulation: `glint experiment rest | lag | sine | prediction | occlusion`.
// Source:   motion_filter.hpp, static_detector.hpp; adaptation: Mehra 1972, Approaches to adaptive
//           filtering (covariance matching), here as one factor with a small step a frame.
#pragma once

#include <span>

#include "kernels/motion/motion_filter.hpp"
#include "kernels/motion/static_detector.hpp"
#include "kernels/nonblocking.hpp"

namespace glint {

struct AdaptationSettings {
  double frames;  // time constant of the factor, in frames of 45 Hz
  double floor;   // without it the noise shrinks at rest and the filter lags the next motion
  double ceiling;
  double nis_ratio_max;  // limit of NIS over its mean: bounds the effect of one bad frame
};

inline constexpr std::size_t k_points_max = 2;  // of a partial measurement: three give a pose

struct ToolMotionSettings {
  MotionSettings motion;
  AdaptationSettings linear{15, 0.55, 10, 2.3};
  AdaptationSettings angular{13, 0.40, 12, 9};
  StaticDetectorSettings rest;
  // Under partial visibility the innovations barely show the hand's motion until all markers are
  // visible again. The noise scale is then its recent maximum, which decays over
  // `peak_scale_frames` frames, times `partial_visibility_noise`.
  double partial_visibility_noise = 2;
  double peak_scale_frames = 1000;
  // Factor on the covariance that inflate_covariance() adds.
  AdaptationSettings inflation{15, 0.01, 10, 1};
  Duration gap_max = milliseconds(1000);  // a longer gap restarts the filter
};

struct MotionUpdate {
  Reason reason = Reason::none;
  int static_tests = 0;  // chi-square tests of the static window's halves
};

// The sums of the static window are stored outside, so this is small enough to feed back from frame
// to frame. A copy from before an update stays valid and undoes that update.
class MotionTrack {
 public:
  // `correlated`: covariances of errors that successive poses share, not in the pose's covariance.
  // Returns frame_duplicate or frame_late if the time stamp does not increase, out_of_range for an
  // invalid pose or covariance. Then nothing has changed.
  MotionUpdate update(const UncertainPose& measured, const CorrelatedErrors& correlated,
                      const ToolMotionSettings& settings,
                      StaticWindowSums& sums) noexcept GLINT_NONBLOCKING;
  // Updates by one or two markers of one time. Returns too_few_markers without an earlier pose
  // within gap_max.
  Reason update(Time time, std::span<const MeasuredPoint> points,
                const ToolMotionSettings& settings,
                const StaticWindowSums& sums) noexcept GLINT_NONBLOCKING;
  void reset() noexcept GLINT_NONBLOCKING;
  // Corrects the parent frame of the estimate by a small motion: every pose p becomes `moved` p.
  void move(const Pose& moved) noexcept GLINT_NONBLOCKING;
  // Inflates the pose's covariance (order as in UncertainPose) by an error of the parent frame
  // since the last measurement. The next innovation contains this error beside the tool's motion.
  void inflate_covariance(const Matrix6& covariance) noexcept GLINT_NONBLOCKING;

  [[nodiscard]] bool known() const { return known_; }
  [[nodiscard]] bool is_static() const { return rest_.is_static(); }
  [[nodiscard]] const Vector3& place() const { return state_.pose.translation; }
  [[nodiscard]] const NoiseScale& noise_scale() const { return scale_; }
  // Factor on the covariance that inflate_covariance() adds, see ToolMotionSettings::inflation.
  [[nodiscard]] double inflation_scale() const { return inflation_scale_; }
  // Noise scale under partial visibility, see partial_visibility_noise.
  [[nodiscard]] NoiseScale partial_visibility_noise_scale(
      const ToolMotionSettings& settings) const {
    return {settings.partial_visibility_noise * peak_scale_.linear,
            settings.partial_visibility_noise * peak_scale_.angular};
  }
  // At the newest measurement's time.
  [[nodiscard]] MotionState estimate(const StaticWindowSums& sums) const noexcept GLINT_NONBLOCKING;
  // Covariance that correlated errors add to estimate()'s position and rotation, at its time.
  [[nodiscard]] Matrix6 correlated_covariance(const StaticWindowSums& sums) const noexcept
      GLINT_NONBLOCKING;
  [[nodiscard]] const Correction& last_correction() const { return correction_; }

 private:
  [[nodiscard]] Reason stamp(Time time) const;

  bool known_ = false;
  MotionState state_;
  Time last_pose_time_;  // of the newest full pose; partial measurements may be newer
  NoiseScale scale_, peak_scale_;
  Matrix6 inflation_ = Matrix6::Zero();   // added by inflate_covariance() since the newest pose
  double inflation_scale_ = 1;            // factor on the covariance passed to inflate_covariance()
  Vector3 innovation_ = Vector3::Zero();  // of the newest pose's position, whitened
  StaticDetector rest_;
  Correction correction_;
};

}  // namespace glint
