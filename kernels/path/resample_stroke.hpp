// Resamples the stroke of a hand-held tip at a declared spacing, with covariances.
//
// What:     outputs the first point, one point per `spacing_m` of distance or `turn_rad` of
//           rotation since the last, and the end point (a stroke without motion has only its first
//           point). A point is between two samples, at a fraction u of their time. Its covariance
//           is (1 - u) Ca + u Cb plus the effect of a hand's acceleration between them. The mean of
//           each sample's neighbours within 20 ms, without the sample itself, selects u. Selection
//           by the samples themselves would prefer, in a slow stroke, samples with noise
//           directed forward.
// Cost:     for a sample 8 neighbours, two square roots; for a point one slerp.
// Worst:    a sample k_stroke_step_max spacings from the last, rotated by 180 deg: that many points
//           and 180 deg / turn_rad more. Samples farther away are rejected.
// Accuracy: the covariance is conservative for any correlation of the errors of a and b ((1 - u) Ca
//           + u Cb - Cov((1 - u) a + u b) is positive semidefinite). It is exact if both have the
//           same error, which is nearly true for consecutive outputs of one filter.
// Source:   Glint's own; the bound is the convexity of x x^T.
#pragma once

#include <array>
#include <cstdint>

#include "kernels/motion/motion_state.hpp"
#include "kernels/nonblocking.hpp"
#include "kernels/reason.hpp"

namespace glint {

inline constexpr int k_stroke_step_max = 512;  // spacings, from one sample to the next

struct StrokeSettings {
  double spacing_m = 0.002;
  double turn_rad = 0.0873;              // 5 deg: also records rotations of a static tip
  Duration gap_max = milliseconds(100);  // between samples; beyond it the path is unknown
  // RMS acceleration of a drawing hand per axis: 35 mm and 0.16 rad up to 1.8 Hz (sim/hand_motion).
  double acceleration_m_s2 = 2.3;
  double angular_acceleration_rad_s2 = 10;
};

class StrokeResampler {
 public:
  enum class Next : std::uint8_t {
    none,          // no further point yet
    point,         // one more
    replace_last,  // the end, so near the last point that it replaces it
  };

  // Starts a new stroke. Returns out_of_range unless all settings are finite and above 0 and
  // turn_rad is at most pi.
  Reason begin(const StrokeSettings& settings) noexcept GLINT_NONBLOCKING;

  // Adds a sample. Rejects it if the time stamp does not increase (frame_late), is more than
  // gap_max after the last (too_old), or the pose is invalid or out of reach (out_of_range).
  Reason add(const UncertainPose& sample) noexcept GLINT_NONBLOCKING;

  // Marks the end of the samples.
  void end() noexcept { ending_ = true; }

  // Call after each add() and end() until it returns none.
  Next next(UncertainPose& point) noexcept GLINT_NONBLOCKING;

 private:
  static constexpr int k_half = 4;  // neighbours on each side, at most
  static constexpr Duration k_neighbour_time_max = milliseconds(20);  // and at most this far away
  static constexpr int k_ring = 2 * k_half + 2;  // neighbours of a segment's two ends

  // Mean pose of a sample's neighbours.
  struct Neighbours {
    Vector3 place = Vector3::Zero();
    Quaternion rotation = Quaternion::Identity();
  };

  [[nodiscard]] const UncertainPose& sample(std::int64_t i) const noexcept;
  [[nodiscard]] Neighbours neighbours_of(std::int64_t middle) const noexcept;
  [[nodiscard]] double crossing() const noexcept;
  [[nodiscard]] UncertainPose between(double u) const noexcept;
  Next last_point(UncertainPose& point) noexcept;

  StrokeSettings settings_;
  std::array<UncertainPose, k_ring> ring_{};
  std::int64_t count_ = 0;   // samples added
  std::int64_t middle_ = 0;  // index of the sample at the end of the current segment
  Neighbours from_, to_;     // the segment's ends
  Neighbours kept_;          // at the last point
  UncertainPose last_;       // the last point
  double processed_ = 0;     // fraction of the segment already processed
  int points_ = 0;           // of the stroke
  bool segment_open_ = false;
  bool ending_ = false, ended_ = false;
};

}  // namespace glint
