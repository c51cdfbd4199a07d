#include "nodes/track_tools.hpp"

namespace glint {
namespace {

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
  track.head_covariance = Matrix6::Zero();
  if (head.valid) track.head_covariance = anchored.lasting_at(track.motion.pose.translation);
}

// The world turned out to lie elsewhere: what is known of the tool moves along.
void move(const AnchoredHead& anchored, Track& track) {
  track.newest.pose = anchored.moved * track.newest.pose;
  track.previous.pose = anchored.moved * track.previous.pose;
  track.motion = moved_state(track.motion, anchored.moved);
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
  estimates.verdict = verdict;
  estimates.tool_count = count;
  estimates.reference_known = anchor.state.known();
  estimates.T_world_reference = anchor.T_world_reference;
  for (int t = 0; t < k_tools_max; ++t) {
    Track& track = estimates.tracks[t];
    if (t >= count) {
      track = Track{};
      estimates.arm_m[t] = Vector3::Zero();
      continue;
    }
    estimates.arm_m[t] = set.items[t].tip_m - set.items[t].middle_m();
    track = last.value().tracks[t];
    if (!verdict.usable()) continue;  // a refused frame changes nothing that is known of a tool
    if (verdict.resynchronised) track = Track{};
    if (anchor.now.moved_along && track.base == ReferenceFrame::world) move(anchor.now, track);

    const FollowedTool& tool = followed[t % k_tool_slices].items[t / k_tool_slices];
    if (tool.reason == Reason::none) {
      ++counts_[2];
      accept(fitted[t % k_tool_slices].tools[t], tool, verdict.stamp, anchor.now,
             settings.velocity_gap_max, track);
      continue;
    }
    track.seen_now = false;
    track.reason = tool.reason;
    if (verdict.stamp.mid_exposure - track.newest.time > settings.lost_after) {
      const Reason why = track.reason;
      track = Track{};
      track.reason = why;
    }
  }
}

}  // namespace glint
