// One tool between frames: the filter for motion, the window for rest, and which of them answers.
//
// What:     a Kalman filter under damped accelerations whose process noise follows the innovations,
//           not below a floor; as long as the rest window holds, its mean is the pose and the tool
//           stands still, or drifts as its halves say. What loosen() adds counts by a factor that
//           follows the correlation of successive innovations.
// Cost:     propagate + correct + rest window: 11 us a measured pose.
// Worst:    a full rest window; nothing else depends on the input.
// Accuracy: by simulation: `glint experiment rest | lag | sine | prediction | occlusion`.
// Source:   motion_filter.hpp, rest_window.hpp; adaptation: Mehra 1972, Approaches to adaptive
//           filtering (covariance matching), here as one factor that each frame moves a little.
#pragma once

#include <span>

#include "kernels/motion/motion_filter.hpp"
#include "kernels/motion/rest_window.hpp"
#include "kernels/nonblocking.hpp"

namespace glint {

struct AdaptationSettings {
  double frames;  // over which the factor follows
  double floor;   // a noise that shrank freely at rest would answer the next start late
  double ceiling;
  double innovation_max;  // of chi square over its mean: one bad frame moves the factor no further
};

inline constexpr std::size_t k_points_max = 2;  // of one partial measurement: three are a pose

struct ToolMotionSettings {
  MotionSettings motion;
  AdaptationSettings linear{15, 0.55, 10, 2.3};
  AdaptationSettings angular{13, 0.40, 12, 9};
  RestSettings rest;
  // One or two markers hold a tool loosely: what the hand does meanwhile shows only when all are
  // back. Then counts the briskest that it was, fading over this many frames, times a factor.
  double partial_noise = 2;
  double briskest_frames = 1000;
  AdaptationSettings loosening{15, 0.01, 10, 1};  // of what loosen() adds
  Duration gap_max = milliseconds(1000);          // after a longer silence it starts anew
};

struct MotionUpdate {
  Reason reason = Reason::none;
  int rest_tests = 0;  // of the rest window's halves
};

// Without the rest window's sums, which stay where they are: small enough to be fed back from frame
// to frame. One that was kept from before an update still holds if that update is to be undone.
class MotionTrack {
 public:
  // `correlated`: of errors that successive poses have in common, not in the pose's covariance.
  // Reason: frame_doubled or frame_late for a stamp that does not rise, out_of_range for a pose
  // that is none. Then nothing has changed.
  MotionUpdate update(const UncertainPose& measured, const CorrelatedErrors& correlated,
                      const ToolMotionSettings& settings,
                      RestSums& sums) noexcept GLINT_NONBLOCKING;
  // One marker or two, of one time; needs a pose before: too_few_markers.
  Reason update(Time time, std::span<const MeasuredPoint> points,
                const ToolMotionSettings& settings,
                const RestSums& sums) noexcept GLINT_NONBLOCKING;
  void forget() noexcept GLINT_NONBLOCKING;
  // The frame that all is given in turned out to lie elsewhere, by little: every pose p becomes
  // `moved` p.
  void move(const Pose& moved) noexcept GLINT_NONBLOCKING;
  // It may since have moved by an error of this covariance, as UncertainPose has it: the next
  // measurement's difference is that error's as well as the tool's.
  void loosen(const Matrix6& covariance) noexcept GLINT_NONBLOCKING;

  [[nodiscard]] bool known() const { return known_; }
  [[nodiscard]] bool rests() const { return rest_.rests(); }
  [[nodiscard]] const Vector3& place() const { return state_.pose.translation; }
  [[nodiscard]] const NoiseScale& noise_scale() const { return scale_; }
  // What one or two markers are followed with: more, see partial_noise.
  [[nodiscard]] NoiseScale partial_noise_scale(const ToolMotionSettings& settings) const {
    return {settings.partial_noise * briskest_.linear, settings.partial_noise * briskest_.angular};
  }
  // At the newest measurement's time.
  [[nodiscard]] MotionState estimate(const RestSums& sums) const noexcept GLINT_NONBLOCKING;
  // What correlated errors add to estimate()'s covariance: to position and rotation, at the same
  // time.
  [[nodiscard]] Matrix6 correlated_covariance(const RestSums& sums) const noexcept
      GLINT_NONBLOCKING;
  [[nodiscard]] const Correction& last_correction() const { return correction_; }

 private:
  [[nodiscard]] Reason stamp(Time time) const;

  bool known_ = false;
  MotionState state_;
  Time posed_;  // the newest pose: since then markers alone hold it
  NoiseScale scale_, briskest_;
  Matrix6 loosened_ = Matrix6::Zero();    // since the newest pose
  double loosening_ = 1;                  // what was declared of it counts by this factor
  Vector3 innovation_ = Vector3::Zero();  // of the newest pose, of unit variance
  RestWindow rest_;
  Correction correction_;
};

}  // namespace glint
