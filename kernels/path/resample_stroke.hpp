// A stroke of a hand-held tip as points a declared distance apart, with their covariances.
//
// What:     a point where the stroke begins, one each time it has gone `spacing_m` or turned
//           `turn_rad` since the last, and one where it ends (a stroke that goes nowhere has its
//           beginning alone). A point lies between two samples, at
//           a share u of their time; its covariance is (1 - u) Ca + u Cb and what a hand's
//           acceleration may have done between them. Where it lies is decided by the mean of each
//           sample's neighbours within 20 ms without itself: decided by the samples, a slow
//           stroke's points would be those whose noise happens to point ahead.
// Cost:     for a sample 8 neighbours, two square roots; for a point one slerp.
// Worst:    a sample k_stroke_reach spacings from the last, turned by 180 deg: that many points and
//           180 deg / turn_rad more. What lies further is refused.
// Accuracy: the covariance is never too small, however the errors of a and b are correlated
//           ((1 - u) Ca + u Cb - Cov((1 - u) a + u b) is positive semidefinite); it is exact where
//           both have one error in common, which neighbours behind one filter nearly have.
// Source:   Glint's own; the bound is the convexity of x x^T.
#pragma once

#include <array>
#include <cstdint>

#include "kernels/motion/motion_state.hpp"
#include "kernels/nonblocking.hpp"
#include "kernels/reason.hpp"

namespace glint {

inline constexpr int k_stroke_reach = 512;  // spacings, from one sample to the next

struct StrokeSettings {
  double spacing_m = 0.002;
  double turn_rad = 0.0873;              // 5 deg: a tip that turns on the spot is kept, too
  Duration gap_max = milliseconds(100);  // from sample to sample; beyond it nobody knows the way
  // What a hand that draws does, rms an axis: 35 mm and 0.16 rad up to 1.8 Hz (sim/hand_motion).
  double acceleration_m_s2 = 2.3;
  double turn_acceleration_rad_s2 = 10;
};

class StrokeResampler {
 public:
  enum class Next : std::uint8_t {
    none,        // no further point yet
    point,       // one more
    last_moves,  // the end, so near the last point that it takes its place
  };

  // A new stroke. Settings must be finite and above 0, turn_rad at most pi: out_of_range.
  Reason begin(const StrokeSettings& settings) noexcept GLINT_NONBLOCKING;

  // Nothing is taken, but for `none`, where the stamp does not rise (frame_late), lies more than
  // gap_max after the last (too_old), or is no pose or out of reach (out_of_range).
  Reason add(const UncertainPose& sample) noexcept GLINT_NONBLOCKING;

  // There are no more samples.
  void end() noexcept { ending_ = true; }

  // After each add() and end(), until it gives none.
  Next next(UncertainPose& point) noexcept GLINT_NONBLOCKING;

 private:
  static constexpr int k_half = 4;                      // neighbours on each side, at most
  static constexpr Duration k_near = milliseconds(20);  // and no further away than this
  static constexpr int k_ring = 2 * k_half + 2;         // a segment's two ends' neighbours

  // Where a sample's neighbours lie on average.
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
  std::int64_t count_ = 0;   // samples taken
  std::int64_t middle_ = 0;  // the sample that the segment under way ends at
  Neighbours from_, to_;     // the segment's ends
  Neighbours kept_;          // at the last point
  UncertainPose last_;       // the last point
  double done_ = 0;          // share of the segment already walked
  int points_ = 0;           // of the stroke
  bool segment_open_ = false;
  bool ending_ = false, ended_ = false;
};

}  // namespace glint
