#include "nodes/track_tools.hpp"

#include <algorithm>

#include "kernels/pose/lever_arm.hpp"

namespace glint {
namespace {

// NIS of the newest measurement over its dimension, at least 1.
double nis_ratio_of(const TrackedTool& followed, double dimension) {
  return std::max(1.0, followed.motion.last_correction().nis / dimension);
}

// Pose of the tool's own frame from that of its marker centroid.
Pose pose_of(const MotionState& middle, const Tool& tool) {
  return {middle.pose.rotation, middle.pose * (-tool.middle_m())};
}

void accept(const FittedTool& found, const TrackedTool& followed, const Tool& tool,
            const FrameStamp& stamp, const CorrectedHead& corrected_head, Duration velocity_gap_max,
            Track& track) {
  const HeadPose& head = corrected_head.head;
  const ReferenceFrame base = head.valid ? ReferenceFrame::world : ReferenceFrame::camera;
  track.is_filter_pose = followed.use_filter_pose;
  Pose pose = head.valid ? head.T_world_camera * found.T_camera_tool : found.T_camera_tool;
  if (track.is_filter_pose) pose = pose_of(followed.estimate, tool);
  track.has_previous = track.alive && track.base == base &&
                       stamp.mid_exposure - track.newest.time <= velocity_gap_max;
  track.previous = track.newest;
  track.newest = {stamp.mid_exposure, pose};
  track.base = base;
  track.alive = true;
  track.unconfirmed = false;
  track.measured_now = true;
  track.reason = Reason::none;
  track.marker_mask = found.marker_mask;
  track.frame_sequence = stamp.sequence;
  track.stamp_sigma = stamp.sigma;
  track.rms_m = found.rms_m;
  track.T_camera_tool = head.valid ? head.T_world_camera.inverse() * pose : pose;
  track.motion = followed.estimate;
  track.noise = followed.noise;
  track.nis_ratio = nis_ratio_of(followed, 6);
  track.head_covariance = Matrix6::Zero();
  if (head.valid) track.head_covariance = corrected_head.shared_at(track.motion.pose.translation);
  const Matrix6& calibration = found.systematic.calibration;
  track.calibration_covariance =
      head.valid ? rotated_covariance(calibration, head.T_world_camera.rotation) : calibration;
  track.correlated_covariance = followed.correlated_covariance;
}

// The tool is tracked, so that later frames may resolve it, but not published.
void accept_unconfirmed(const FittedTool& found, const TrackedTool& followed, const Tool& tool,
                        const FrameStamp& stamp, const CorrectedHead& corrected_head,
                        Duration velocity_gap_max, Reason why, Track& track) {
  accept(found, followed, tool, stamp, corrected_head, velocity_gap_max, track);
  track.unconfirmed = true;
  track.measured_now = false;
  track.reason = why;
}

// Updates the motion; the newest measured pose is kept.
void update_motion(const TrackedTool& followed, double dimension, Track& track) {
  track.motion = followed.estimate;
  track.noise = followed.noise;
  track.correlated_covariance = followed.correlated_covariance;
  track.nis_ratio = nis_ratio_of(followed, dimension);
}

// Update by one or two markers. These give no pose of their own: the filter's is stored.
void accept_partial(const TrackedTool& followed, const Tool& tool, const FrameStamp& stamp,
                    const CorrectedHead& corrected_head, Track& track) {
  update_motion(followed, 3, track);
  if (!followed.is_publishable) return;
  const HeadPose& head = corrected_head.head;
  const Pose pose = pose_of(track.motion, tool);
  track.is_filter_pose = true;
  track.has_previous = false;
  track.newest = {stamp.mid_exposure, pose};
  track.marker_mask = followed.partial_mask;
  track.frame_sequence = stamp.sequence;
  track.stamp_sigma = stamp.sigma;
  track.T_camera_tool = head.valid ? head.T_world_camera.inverse() * pose : pose;
  track.head_covariance = Matrix6::Zero();
  if (head.valid) track.head_covariance = corrected_head.shared_at(track.motion.pose.translation);
}

// The world frame was corrected after a gap: moves the track along.
void move(const CorrectedHead& corrected_head, Track& track) {
  track.newest.pose = corrected_head.gap_correction * track.newest.pose;
  track.previous.pose = corrected_head.gap_correction * track.previous.pose;
  track.motion = transformed_state(track.motion, corrected_head.gap_correction);
}

void restart(const Tool& tool, Track& track) {
  track = Track{};
  track.identity = tool.identity;
}

// A slot that was empty from the start has not changed.
void replace_tool(const Tool& tool, Track& track) {
  const bool first = track.identity == 0 && track.reason == Reason::no_frame_yet;
  restart(tool, track);
  if (!first) track.reason = Reason::tool_changed;
}

}  // namespace

void TrackTools::operator()(const FrameVerdict& verdict, const Anchor& anchor,
                            const graph::Latest<ToolSet>& tools,
                            const graph::Parts<FittedTools, k_tool_partitions>& fitted,
                            const graph::Parts<FollowedTools, k_tool_partitions>& followed,
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
  estimates.has_reference = anchor.state.known();
  estimates.T_world_reference = anchor.T_world_reference;
  estimates.noise = last.value().noise;
  for (int t = 0; t < count; ++t) {
    Track& track = estimates.tracks[t];
    const Tool& shape = set.items[t];
    estimates.tips[t] = tip_of(shape);
    track = last.value().tracks[t];
    if (track.identity != shape.identity) replace_tool(shape, track);
    if (!shape.present()) continue;
    if (!verdict.usable()) continue;  // a rejected frame leaves the track unchanged
    if (verdict.resynchronised) restart(shape, track);
    if (anchor.now.moved_along && track.base == ReferenceFrame::world) move(anchor.now, track);

    const TrackedTool& tool = followed[t % k_tool_partitions].items[t / k_tool_partitions];
    const FittedTool& found = fitted[t % k_tool_partitions].tools[t];
    if (tool.reason == Reason::none) track.odds = found.odds;
    // Imprecise poses count, too: otherwise a too large estimate would keep every pose imprecise.
    if (tool.reason == Reason::none && estimate_noise) add(found.residuals, noise, estimates.noise);
    if (tool.reason == Reason::none && tool.is_publishable) {
      ++counts_[graph::loop_of<TrackTools>("found")];
      accept(found, tool, shape, verdict.stamp, anchor.now, settings.velocity_gap_max, track);
      continue;
    }
    track.measured_now = false;
    const Reason why = tool.reason != Reason::none ? tool.reason
                       : tool.ambiguous            ? Reason::ambiguous
                                                   : Reason::imprecise;
    track.reason = why;
    const bool goes_on =
        track.alive && !track.unconfirmed && !found.contradicts_track && track.base == tool.base;
    if (tool.reason == Reason::none && !goes_on) {
      accept_unconfirmed(found, tool, shape, verdict.stamp, anchor.now, settings.velocity_gap_max,
                         why, track);
      continue;
    }
    if (tool.reason == Reason::none && track.alive && track.base == tool.base)
      update_motion(tool, 6, track);
    if (tool.partial_mask != 0 && track.alive)
      accept_partial(tool, shape, verdict.stamp, anchor.now, track);
    if (verdict.stamp.mid_exposure - track.newest.time > settings.lost_after) {
      restart(shape, track);
      track.reason = why;
    }
  }
}

Matrix6 tip_covariance(const Track& track, const FittedTool& found,
                       const TipPosition& tip) noexcept {
  const Matrix6 systematic =
      tip.systematic_of(found.systematic.calibration + found.systematic.correlated.sum(),
                        track.T_camera_tool.rotation);
  if (!track.is_filter_pose) return found.covariance + systematic;
  Matrix6 covariance;
  for (int i = 0; i < 2; ++i) {
    for (int j = 0; j < 2; ++j) {
      constexpr int k_block_start[] = {k_position, k_rotation};
      covariance.block<3, 3>(3 * i, 3 * j) =
          track.motion.covariance.block<3, 3>(k_block_start[i], k_block_start[j]);
    }
  }
  const Quaternion camera_base =
      track.T_camera_tool.rotation * track.newest.pose.rotation.conjugate();
  return systematic + moved_covariance(rotated_covariance(covariance, camera_base),
                                       track.T_camera_tool.rotation * tip.arm_m);
}

}  // namespace glint
