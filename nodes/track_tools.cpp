#include "nodes/track_tools.hpp"

#include <algorithm>

namespace glint {
namespace {

// More than the filter foretold of the newest measurement, of so many numbers.
double surprise_of(const FollowedTool& followed, double numbers) {
  return std::max(1.0, followed.motion.last_correction().chi_square / numbers);
}

void accept(const FittedTool& found, const FollowedTool& followed, const FrameStamp& stamp,
            const AnchoredHead& anchored, Duration velocity_gap_max, Track& track) {
  const HeadPose& head = anchored.head;
  const ReferenceFrame base = head.valid ? ReferenceFrame::world : ReferenceFrame::camera;
  const Pose pose = head.valid ? head.T_world_camera * found.T_camera_tool : found.T_camera_tool;
  track.has_previous = track.alive && track.base == base &&
                       stamp.mid_exposure - track.newest.time <= velocity_gap_max;
  track.previous = track.newest;
  track.newest = {stamp.mid_exposure, pose};
  track.base = base;
  track.alive = true;
  track.seen_now = true;
  track.reason = Reason::none;
  track.marker_mask = found.marker_mask;
  track.frame_sequence = stamp.sequence;
  track.rms_m = found.rms_m;
  track.T_camera_tool = found.T_camera_tool;
  track.motion = followed.estimate;
  track.noise = followed.noise;
  track.surprise = surprise_of(followed, 6);
  track.head_covariance = Matrix6::Zero();
  if (head.valid) track.head_covariance = anchored.lasting_at(track.motion.pose.translation);
}

// What is known goes on, but is no measurement.
void move_on(const FollowedTool& followed, double numbers, Track& track) {
  track.motion = followed.estimate;
  track.noise = followed.noise;
  track.surprise = surprise_of(followed, numbers);
}

// One or two markers moved it on. The pose that stands is the filter's, for they give none.
void accept_few(const FollowedTool& followed, const Tool& tool, const FrameStamp& stamp,
                const AnchoredHead& anchored, Track& track) {
  move_on(followed, 3, track);
  if (!followed.stands) return;
  const HeadPose& head = anchored.head;
  const Pose& middle = track.motion.pose;
  const Pose pose{middle.rotation, middle * (-tool.middle_m())};
  track.has_previous = false;
  track.newest = {stamp.mid_exposure, pose};
  track.marker_mask = followed.few_mask;
  track.frame_sequence = stamp.sequence;
  track.T_camera_tool = head.valid ? head.T_world_camera.inverse() * pose : pose;
  track.head_covariance = Matrix6::Zero();
  if (head.valid) track.head_covariance = anchored.lasting_at(middle.translation);
}

// The world turned out to lie elsewhere: what is known of the tool moves along.
void move(const AnchoredHead& anchored, Track& track) {
  track.newest.pose = anchored.moved * track.newest.pose;
  track.previous.pose = anchored.moved * track.previous.pose;
  track.motion = moved_state(track.motion, anchored.moved);
}

void restart(const Tool& tool, Track& track) {
  track = Track{};
  track.identity = tool.identity;
}

// Of a slot that was empty from the start nothing has changed.
void exchange(const Tool& tool, Track& track) {
  const bool first = track.identity == 0 && track.reason == Reason::no_frame_yet;
  restart(tool, track);
  if (!first) track.reason = Reason::tool_changed;
}

}  // namespace

void TrackTools::operator()(const FrameVerdict& verdict, const Anchor& anchor,
                            const graph::Latest<ToolSet>& tools,
                            const graph::Parts<FittedTools, k_tool_slices>& fitted,
                            const graph::Parts<FollowedTools, k_tool_slices>& followed,
                            const graph::Previous<Estimates>& last, Estimates& estimates) noexcept {
  const ToolSet& set = tools.value();
  const int count = tools_within(set, limits);
  counts_ = {{1, count}};
  // Beyond those that this token held before all is clear; to clear it again would cost more than
  // to track a tool.
  for (int t = count; t < std::min(estimates.tool_count, k_tools_max); ++t) {
    estimates.tracks[t] = Track{};
    estimates.arm_m[t] = Vector3::Zero();
  }
  estimates.verdict = verdict;
  estimates.tool_count = count;
  estimates.reference_known = anchor.state.known();
  estimates.T_world_reference = anchor.T_world_reference;
  estimates.noise = last.value().noise;
  for (int t = 0; t < count; ++t) {
    Track& track = estimates.tracks[t];
    const Tool& shape = set.items[t];
    estimates.arm_m[t] = shape.tip_m - shape.middle_m();
    track = last.value().tracks[t];
    if (track.identity != shape.identity) exchange(shape, track);
    if (!shape.present()) continue;
    if (!verdict.usable()) continue;  // a refused frame changes nothing that is known of a tool
    if (verdict.resynchronised) restart(shape, track);
    if (anchor.now.moved_along && track.base == ReferenceFrame::world) move(anchor.now, track);

    const FollowedTool& tool = followed[t % k_tool_slices].items[t / k_tool_slices];
    // Of an imprecise pose, too: too large an estimate would else keep every pose imprecise.
    if (tool.reason == Reason::none && estimate_noise)
      add(fitted[t % k_tool_slices].tools[t].residuals, noise, estimates.noise);
    if (tool.reason == Reason::none && tool.stands) {
      ++counts_[2];
      accept(fitted[t % k_tool_slices].tools[t], tool, verdict.stamp, anchor.now,
             settings.velocity_gap_max, track);
      continue;
    }
    track.seen_now = false;
    track.reason = tool.reason != Reason::none ? tool.reason : Reason::imprecise;
    if (tool.reason == Reason::none && track.alive && track.base == tool.base)
      move_on(tool, 6, track);
    if (tool.few_mask != 0 && track.alive)
      accept_few(tool, shape, verdict.stamp, anchor.now, track);
    if (verdict.stamp.mid_exposure - track.newest.time > settings.lost_after) {
      const Reason why = track.reason;
      restart(shape, track);
      track.reason = why;
    }
  }
}

}  // namespace glint
