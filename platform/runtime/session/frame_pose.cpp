#include "platform/runtime/session/frame_pose.hpp"

#include "kernels/pose/lever_arm.hpp"

namespace glint {
namespace {

// Covariance of the pose: translation of its origin, rotation about the frame's axes.
Matrix6 covariance_of(const FittedTool& fit, const Track& track, const Tool& tool,
                      PoseOrigin origin) {
  TipPosition tip = tip_of(tool);
  if (origin == PoseOrigin::tool) tip.sigma_m = 0;  // no tip error in the tool's origin
  Matrix6 covariance = tip_covariance(track, fit, tip);
  if (origin == PoseOrigin::tool) {
    covariance = moved_covariance(covariance, track.T_camera_tool.rotation * (-tool.tip_m));
  }
  if (track.base != ReferenceFrame::world) return covariance;
  const Quaternion world_camera =
      track.newest.pose.rotation * track.T_camera_tool.rotation.conjugate();
  // head_covariance refers to the centroid of the markers.
  const Vector3 to = (origin == PoseOrigin::tip ? tool.tip_m : Vector3(Vector3::Zero()));
  return rotated_covariance(covariance, world_camera) +
         moved_covariance(track.head_covariance,
                          track.newest.pose.rotation * (to - tool.middle_m()));
}

}  // namespace

Pose with_origin(const Pose& T_frame_tool, const Tool& tool, PoseOrigin origin) {
  if (origin == PoseOrigin::tool) return T_frame_tool;
  return {T_frame_tool.rotation, T_frame_tool * tool.tip_m};
}

FramePose frame_pose(const Frame& frame, Tracker& tracker, const Tool& tool, std::size_t index,
                     PoseOrigin origin) {
  const Track& track = tracker.output<Estimates>().tracks[index];
  FramePose pose;
  pose.time = frame.mid_exposure;
  pose.sequence = frame.sequence;
  pose.tool = tool.name.data();
  pose.reason = track.reason;
  pose.state = track.measured_now                  ? TrackState::measured
               : track.alive && !track.unconfirmed ? TrackState::predicted
                                                   : TrackState::lost;
  if (!track.measured_now) return pose;
  const FittedTool& fit =
      tracker.parts<FittedTools>(static_cast<int>(index) % k_tool_partitions).tools[index];
  pose.frame = track.base;
  pose.marker_mask = track.marker_mask;
  pose.rms_m = track.rms_m;
  pose.pose = with_origin(track.newest.pose, tool, origin);
  pose.covariance = covariance_of(fit, track, tool, origin);
  return pose;
}

}  // namespace glint
