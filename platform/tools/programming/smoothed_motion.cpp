#include "platform/tools/programming/smoothed_motion.hpp"

#include <algorithm>
#include <string>

#include "kernels/motion/interpolate.hpp"
#include "platform/input_error.hpp"

namespace glint {
namespace {

Time time_of(const MeasuredFrame& frame) { return frame.frame.measured.time; }

std::string seconds_text(Time time) {
  return std::to_string(static_cast<double>(time.nanoseconds) * 1e-9) + " s";
}

}  // namespace

SmoothedMotion::SmoothedMotion(const std::vector<MeasuredFrame>& frames,
                               const SmoothedMotionSettings& settings)
    : frames_(frames), settings_(settings) {}

bool SmoothedMotion::continues(std::size_t frame) const {
  const MeasuredFrame& here = frames_[frame];
  const Duration gap = time_of(here) - time_of(frames_[frame - 1]);
  const Duration most = here.frames_without > 0 ? settings_.hidden_gap_max : settings_.slow_gap_max;
  return !here.restarts && gap.nanoseconds > 0 && gap <= most;
}

void SmoothedMotion::smooth(std::size_t begin, std::size_t end) {
  Segment& segment = segments_.emplace_back();
  segment.first = begin;
  for (std::size_t i = begin; i < end; ++i) segment.frames.push_back(frames_[i].frame);
  segment.memory.resize(segment.frames.size());
  const Reason reason = segment.smoother.smooth(segment.frames, settings_.motion, segment.memory);
  if (reason != Reason::none) {
    throw InputError("path: the stroke from " + seconds_text(time_of(frames_[begin])) + " to " +
                     seconds_text(time_of(frames_[end - 1])) +
                     " cannot be smoothed: " + std::string(name_of(reason)) +
                     "; expected at most " + std::to_string(k_stroke_frames_max) +
                     " measured frames; --live keeps the "
                     "poses as sent");
  }
}

void SmoothedMotion::select(Time from, Time to) {
  segments_.clear();
  std::size_t begin = frames_.size();
  for (std::size_t i = 0; i < frames_.size(); ++i) {
    const Time time = time_of(frames_[i]);
    const bool wanted = time >= from - settings_.margin && time <= to + settings_.margin;
    if (begin < i && (!wanted || !continues(i))) {
      smooth(begin, i);
      begin = frames_.size();
    }
    if (!wanted) continue;
    begin = std::min(begin, i);
    frames_used_ += time >= from && time <= to ? 1 : 0;
  }
  if (begin < frames_.size()) smooth(begin, frames_.size());
}

bool SmoothedMotion::write(PoseSample& sample) const {
  for (const Segment& segment : segments_) {
    const Result<MotionState> state = segment.smoother.at(sample.tick, segment.frames);
    if (!state) continue;
    // The state is in the parent frame of the first frame that is not earlier.
    std::size_t i = segment.first;
    while (time_of(frames_[i]) < sample.tick) ++i;
    const MeasuredFrame& after = frames_[i];
    const MeasuredFrame& before = i > segment.first ? frames_[i - 1] : after;
    const double gap_s = (time_of(after) - time_of(before)).seconds();
    const double share = gap_s > 0 ? (sample.tick - time_of(before)).seconds() / gap_s : 1;
    CentroidEstimate centroid;
    centroid.moving = {state.value.pose, state.value.velocity_m_s,
                       state.value.angular_velocity_rad_s};
    centroid.covariance = pose_of(state.value).covariance + (1 - share) * before.head_covariance +
                          share * after.head_covariance;
    centroid.systematic = (1 - share) * before.systematic + share * after.systematic;
    centroid.stamp_s2 = std::max(before.stamp_s2, after.stamp_s2);
    const bool in_robot = after.base == ReferenceFrame::world && after.has_robot;
    write_tip(centroid, in_robot ? &after.T_base_robot : nullptr, settings_.robot_covariance,
              after.tip, sample);
    sample.state = TrackState::measured;
    sample.frame = in_robot ? ReferenceFrame::robot : after.base;
    sample.measurement = sample.tick;
    return true;
  }
  return false;
}

}  // namespace glint
