#include "kernels/path/smooth_stroke.hpp"

#include <cmath>

#include "kernels/motion/cholesky.hpp"

namespace glint {
namespace {

constexpr double k_unit_norm_tolerance = 1e-6;

bool is_usable(const StrokeFrame& frame) {
  const Pose& pose = frame.measured.pose;
  const Pose& moved = frame.parent_moved;
  const bool finite = pose.translation.allFinite() && frame.measured.covariance.allFinite() &&
                      moved.translation.allFinite() && frame.parent_noise.allFinite();
  // A NaN fails each comparison.
  return finite && std::abs(pose.rotation.norm() - 1) <= k_unit_norm_tolerance &&
         std::abs(moved.rotation.norm() - 1) <= k_unit_norm_tolerance && frame.noise.linear >= 0 &&
         frame.noise.angular >= 0 && std::isfinite(frame.noise.linear + frame.noise.angular);
}

Reason check(std::span<const StrokeFrame> frames) {
  for (std::size_t i = 0; i < frames.size(); ++i) {
    if (!is_usable(frames[i])) return Reason::out_of_range;
    if (!Cholesky<6>(frames[i].measured.covariance).positive) return Reason::degenerate;
    if (i == 0) continue;
    const Time before = frames[i - 1].measured.time;
    if (frames[i].measured.time == before) return Reason::frame_duplicate;
    if (frames[i].measured.time < before) return Reason::frame_late;
  }
  return Reason::none;
}

// The state in the next frame's parent frame, with that frame's error.
MotionState in_next_parent(const MotionState& state, const StrokeFrame& next) {
  MotionState moved = transformed_state(state, next.parent_moved);
  for (int i = 0; i < 2; ++i)
    for (int j = 0; j < 2; ++j)
      moved.covariance.block<3, 3>(i == 0 ? k_position : k_rotation,
                                   j == 0 ? k_position : k_rotation) +=
          next.parent_noise.block<3, 3>(3 * i, 3 * j);
  return moved;
}

// One backward step: the smoothed state at the time of `filtered` from that at a later time.
Result<MotionState> smoothed_before(const MotionState& filtered, const MotionState& after,
                                    const MotionSettings& settings, const NoiseScale& noise) {
  MotionState predicted = filtered;
  propagate(predicted, after.time, settings, noise);
  const Cholesky<k_motion_size> root(predicted.covariance);
  if (!root.positive) return {filtered, Reason::degenerate};
  const MotionCovariance transition = transition_to(filtered, after.time, settings);
  const MotionCovariance moved = transition.lazyProduct(filtered.covariance);
  MotionCovariance gain;  // G = (P_p^-1 F P_f)'
  for (int i = 0; i < k_motion_size; ++i) gain.row(i) = root.solve(moved.col(i)).transpose();
  Result<MotionState> smoothed{filtered};
  add_error(smoothed.value, gain.lazyProduct(motion_difference(after, predicted)));
  const MotionCovariance gained =
      gain.lazyProduct(MotionCovariance(after.covariance - predicted.covariance));
  MotionCovariance& p = smoothed.value.covariance;
  p += gained.lazyProduct(gain.transpose());
  p = (0.5 * (p + p.transpose())).eval();
  return smoothed;
}

}  // namespace

// Leaves the filtered state of each frame in its own parent frame in `smoothed`, and in the next
// frame's in `filtered`.
Reason StrokeSmoother::filter(std::span<const StrokeFrame> frames) noexcept {
  MotionState state = initial_motion_state(frames.front().measured, settings_);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    if (i > 0) {
      state = states_[i - 1].filtered = in_next_parent(state, frames[i]);
      propagate(state, frames[i].measured.time, settings_, frames[i].noise);
      const Correction correction = correct_by_pose(state, frames[i].measured);
      if (correction.reason != Reason::none) return correction.reason;
    }
    states_[i].filtered = states_[i].smoothed = state;
  }
  return Reason::none;
}

Reason StrokeSmoother::smooth(std::span<const StrokeFrame> frames, const MotionSettings& settings,
                              std::span<SmoothedFrame> memory) noexcept {
  states_ = {};
  settings_ = settings;
  if (frames.empty()) return Reason::no_frame_yet;
  if (frames.size() > k_stroke_frames_max) return Reason::out_of_range;
  if (frames.size() > memory.size()) return Reason::not_prepared;
  Reason reason = check(frames);
  if (reason != Reason::none) return reason;
  states_ = memory.first(frames.size());
  reason = filter(frames);
  for (std::size_t i = frames.size() - 1; i > 0 && reason == Reason::none; --i) {
    const Result<MotionState> before =
        smoothed_before(states_[i - 1].filtered, states_[i].smoothed, settings_, frames[i].noise);
    reason = before.reason;
    states_[i - 1].smoothed = transformed_state(before.value, frames[i].parent_moved.inverse());
  }
  if (reason != Reason::none) states_ = {};
  return reason;
}

Result<MotionState> StrokeSmoother::at(Time time,
                                       std::span<const StrokeFrame> frames) const noexcept {
  if (states_.empty() || frames.size() != states_.size()) return {{}, Reason::no_frame_yet};
  if (time < states_.front().smoothed.time || time > states_.back().smoothed.time)
    return {{}, Reason::out_of_range};
  std::size_t first = 0, last = states_.size() - 1;  // the first frame that is not earlier
  while (first < last) {
    const std::size_t middle = first + (last - first) / 2;
    if (states_[middle].smoothed.time < time) {
      first = middle + 1;
    } else {
      last = middle;
    }
  }
  if (states_[first].smoothed.time == time) return {states_[first].smoothed};
  MotionState between = states_[first - 1].filtered;
  propagate(between, time, settings_, frames[first].noise);
  return smoothed_before(between, states_[first].smoothed, settings_, frames[first].noise);
}

}  // namespace glint
