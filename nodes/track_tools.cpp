#include "nodes/track_tools.hpp"

#include <algorithm>

#include "kernels/pose/lever_arm.hpp"

namespace glint {
namespace {

// NIS of the newest measurement over its dimension, at least 1.
double surprise_of(const FollowedTool& followed, double numbers) {
  return std::max(1.0, followed.motion.last_correction().chi_square / numbers);
}

// Pose of the tool's own frame from that of its marker centroid.
Pose pose_of(const MotionState& middle, const Tool& tool) {
  return {middle.pose.rotation, middle.pose * (-tool.middle_m())};
}

void accept(const FittedTool& found, const FollowedTool& followed, const Tool& tool,
            const FrameStamp& stamp, const AnchoredHead& anchored, Duration velocity_gap_max,
            Track& track) {
  const HeadPose& head = anchored.head;
  const ReferenceFrame base = head.valid ? ReferenceFrame::world : ReferenceFrame::camera;
  track.filtered = followed.filtered;
  Pose pose = head.valid ? head.T_world_camera * found.T_camera_tool : found.T_camera_tool;
  if (track.filtered) pose = pose_of(followed.estimate, tool);
  track.has_previous = track.alive && track.base == base &&
                       stamp.mid_exposure - track.newest.time <= velocity_gap_max;
  track.previous = track.newest;
  track.newest = {stamp.mid_exposure, pose};
  track.base = base;
  track.alive = true;
  track.doubted = false;
  track.seen_now = true;
  track.reason = Reason::none;
  track.marker_mask = found.marker_mask;
  track.frame_sequence = stamp.sequence;
  track.stamp_sigma = stamp.sigma;
  track.rms_m = found.rms_m;
  track.T_camera_tool = head.valid ? head.T_world_camera.inverse() * pose : pose;
  track.motion = followed.estimate;
  track.noise = followed.noise;
  track.surprise = surprise_of(followed, 6);
  track.head_covariance = Matrix6::Zero();
  if (head.valid) track.head_covariance = anchored.lasting_at(track.motion.pose.translation);
  const Matrix6& calibration = found.systematic.calibration;
  track.calibration_covariance =
      head.valid ? turned_covariance(calibration, head.T_world_camera.rotation) : calibration;
  track.correlated_covariance = followed.correlated_covariance;
}

// The tool is tracked, so that later frames may resolve it, but not published.
void doubt(const FittedTool& found, const FollowedTool& followed, const Tool& tool,
           const FrameStamp& stamp, const AnchoredHead& anchored, Duration velocity_gap_max,
           Reason why, Track& track) {
  accept(found, followed, tool, stamp, anchored, velocity_gap_max, track);
  track.doubted = true;
  track.seen_now = false;
  track.reason = why;
}

// Updates the motion; the newest measured pose is kept.
void move_on(const FollowedTool& followed, double numbers, Track& track) {
  track.motion = followed.estimate;
  track.noise = followed.noise;
  track.correlated_covariance = followed.correlated_covariance;
  track.surprise = surprise_of(followed, numbers);
}

// Update by one or two markers. These give no pose of their own: the filter's is stored.
void accept_few(const FollowedTool& followed, const Tool& tool, const FrameStamp& stamp,
                const AnchoredHead& anchored, Track& track) {
  move_on(followed, 3, track);
  if (!followed.stands) return;
  const HeadPose& head = anchored.head;
  const Pose pose = pose_of(track.motion, tool);
  track.filtered = true;
  track.has_previous = false;
  track.newest = {stamp.mid_exposure, pose};
  track.marker_mask = followed.few_mask;
  track.frame_sequence = stamp.sequence;
  track.stamp_sigma = stamp.sigma;
  track.T_camera_tool = head.valid ? head.T_world_camera.inverse() * pose : pose;
  track.head_covariance = Matrix6::Zero();
  if (head.valid) track.head_covariance = anchored.lasting_at(track.motion.pose.translation);
}

// The world frame was corrected after a gap: moves the track along.
void move(const AnchoredHead& anchored, Track& track) {
  track.newest.pose = anchored.moved * track.newest.pose;
  track.previous.pose = anchored.moved * track.previous.pose;
  track.motion = moved_state(track.motion, anchored.moved);
}

void restart(const Tool& tool, Track& track) {
  track = Track{};
  track.identity = tool.identity;
}

// A slot that was empty from the start has not changed.
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
  // Tracks beyond this token's last tool_count are clear; clearing them again would cost more than
  // tracking a tool.
  for (int t = count; t < std::min(estimates.tool_count, k_tools_max); ++t) {
    estimates.tracks[t] = Track{};
    estimates.tips[t] = {};
  }
  estimates.verdict = verdict;
  estimates.tool_count = count;
  estimates.reference_known = anchor.state.known();
  estimates.T_world_reference = anchor.T_world_reference;
  estimates.noise = last.value().noise;
  for (int t = 0; t < count; ++t) {
    Track& track = estimates.tracks[t];
    const Tool& shape = set.items[t];
    estimates.tips[t] = tip_of(shape);
    track = last.value().tracks[t];
    if (track.identity != shape.identity) exchange(shape, track);
    if (!shape.present()) continue;
    if (!verdict.usable()) continue;  // a rejected frame leaves the track unchanged
    if (verdict.resynchronised) restart(shape, track);
    if (anchor.now.moved_along && track.base == ReferenceFrame::world) move(anchor.now, track);

    const FollowedTool& tool = followed[t % k_tool_slices].items[t / k_tool_slices];
    const FittedTool& found = fitted[t % k_tool_slices].tools[t];
    if (tool.reason == Reason::none) track.odds = found.odds;
    // Imprecise poses count, too: otherwise a too large estimate would keep every pose imprecise.
    if (tool.reason == Reason::none && estimate_noise) add(found.residuals, noise, estimates.noise);
    if (tool.reason == Reason::none && tool.stands) {
      ++counts_[2];
      accept(found, tool, shape, verdict.stamp, anchor.now, settings.velocity_gap_max, track);
      continue;
    }
    track.seen_now = false;
    const Reason why = tool.reason != Reason::none ? tool.reason
                       : tool.ambiguous            ? Reason::ambiguous
                                                   : Reason::imprecise;
    track.reason = why;
    const bool goes_on = track.alive && !track.doubted && !found.turned && track.base == tool.base;
    if (tool.reason == Reason::none && !goes_on) {
      doubt(found, tool, shape, verdict.stamp, anchor.now, settings.velocity_gap_max, why, track);
      continue;
    }
    if (tool.reason == Reason::none && track.alive && track.base == tool.base)
      move_on(tool, 6, track);
    if (tool.few_mask != 0 && track.alive)
      accept_few(tool, shape, verdict.stamp, anchor.now, track);
    if (verdict.stamp.mid_exposure - track.newest.time > settings.lost_after) {
      restart(shape, track);
      track.reason = why;
    }
  }
}

Matrix6 tip_covariance(const Track& track, const FittedTool& found, const TipPlace& tip) noexcept {
  const Matrix6 systematic =
      tip.systematic_of(found.systematic.calibration + found.systematic.correlated.sum(),
                        track.T_camera_tool.rotation);
  if (!track.filtered) return found.covariance + systematic;
  Matrix6 covariance;
  for (int i = 0; i < 2; ++i) {
    for (int j = 0; j < 2; ++j) {
      constexpr int k_place[] = {k_position, k_rotation};
      covariance.block<3, 3>(3 * i, 3 * j) =
          track.motion.covariance.block<3, 3>(k_place[i], k_place[j]);
    }
  }
  const Quaternion camera_base =
      track.T_camera_tool.rotation * track.newest.pose.rotation.conjugate();
  return systematic + moved_covariance(turned_covariance(covariance, camera_base),
                                       track.T_camera_tool.rotation * tip.arm_m);
}

}  // namespace glint
