// Fixed-interval smoother of a stroke: the tool's motion at any time between its first and its last
// measured frame, estimated from all of them.
//
// What:     forward, the Kalman filter of motion_filter.hpp over the frames' poses; backward, from
//           the last frame on, x = f + G (x' - p'), P = P_f + G (P' - P_p) G', G = P_f F' P_p^-1,
//           with the filtered state f, its prediction p' at the next time and the smoothed x'
//           there. Between two frames the same step starts from the state predicted to that time.
//           Errors that frames share are neither in the frames' covariances nor in the result's:
//           the caller adds them afterwards, since a mean over frames does not reduce them.
// Cost:     smooth: a frame 30 us (a Cholesky factor of 18 rows, four products of 18 x 18). at: one
//           step more and a binary search.
// Worst:    k_stroke_frames_max frames; otherwise data independent.
// Accuracy: exact for a linear model: it equals the batch least-squares solution. Rotations to
//           first order in their errors, as in the filter. A result's covariance is at most the
//           filter's.
// Source:   Rauch, Tung and Striebel 1965, Maximum likelihood estimates of linear dynamic systems,
//           section III; in this form Sarkka 2013, Bayesian Filtering and Smoothing, eq. (8.6).
#pragma once

#include <cstdint>
#include <span>

#include "kernels/motion/motion_filter.hpp"
#include "kernels/nonblocking.hpp"
#include "kernels/result.hpp"

namespace glint {

inline constexpr std::size_t k_stroke_frames_max = 8192;  // 3 minutes at 45 Hz

// A measured frame and what changed since the previous one.
struct StrokeFrame {
  // Pose of the marker centroid in its parent frame; covariance of the errors that are independent
  // of all other frames.
  UncertainPose measured;
  NoiseScale noise;  // factors on the process noise
  // Correction of the parent frame: earlier poses p are `parent_moved` p in this frame's parent.
  Pose parent_moved;
  Matrix6 parent_noise = Matrix6::Zero();  // covariance of the parent frame's error
};

// Memory of one frame.
struct SmoothedFrame {
  MotionState filtered;  // at this frame, in the parent frame of the next one
  MotionState smoothed;  // at this frame, in its own parent frame
};

class StrokeSmoother {
 public:
  // Uses the first frames.size() entries of `memory`, which must live as long as at() is called.
  // Without a result at() returns no_frame_yet; the reasons are
  //   no_frame_yet     no frame
  //   not_prepared     more frames than `memory` holds
  //   out_of_range     more than k_stroke_frames_max; a number that is not finite, a rotation that
  //                    is not a unit quaternion, a negative noise factor
  //   frame_late, frame_duplicate  a time stamp that does not increase
  //   degenerate       a covariance that is not positive definite
  [[nodiscard]] Reason smooth(std::span<const StrokeFrame> frames, const MotionSettings& settings,
                              std::span<SmoothedFrame> memory) noexcept GLINT_NONBLOCKING;

  // Smoothed state at `time`: in the parent frame of the first frame that is not earlier. Returns
  // out_of_range outside the frames. `frames` as in smooth().
  [[nodiscard]] Result<MotionState> at(
      Time time, std::span<const StrokeFrame> frames) const noexcept GLINT_NONBLOCKING;

 private:
  [[nodiscard]] Reason filter(std::span<const StrokeFrame> frames) noexcept GLINT_NONBLOCKING;

  MotionSettings settings_;
  std::span<SmoothedFrame> states_;
};

}  // namespace glint
