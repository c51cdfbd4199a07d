#include "platform/lab/experiments/glint_chain.hpp"

#include "kernels/pose/lever_arm.hpp"
#include "platform/runtime/session/pipeline.hpp"

namespace glint {

GlintChain::GlintChain(const Camera& camera, const Tool& tool, SearchArea area)
    : GlintChain(camera, ChainSetup{{tool}, -1, {}, area}) {}

GlintChain::GlintChain(const Camera& camera, const ChainSetup& setup)
    : tracker_(std::make_unique<Tracker>()) {
  Cell cell = default_cell();
  set_camera(cell, camera);
  cell.camera.uncertainty = k_exact_camera;  // only random errors are judged
  cell.tools.count = 0;
  for (const Tool& tool : setup.tools)
    cell.tools.items[static_cast<std::size_t>(cell.tools.count++)] = tool;
  for (Tool& tool : cell.tools.items) tool.marker_sigma_m = tool.tip_sigma_m = 0;
  cell.reference = setup.reference;
  cell.head_noise = setup.head_noise;
  configure(cell, *tracker_);
  if (setup.area == SearchArea::whole_frame)
    tracker_->node<PredictTracks>().settings.lost_after = Duration{0};
  tracker_->latest<ToolSet>().set(cell.tools, 1, 0);
}

Result<Pose> GlintChain::process(const Frame& frame, const HeadPose& head) {
  tracker_->input<Frame>() = frame;
  tracker_->input<HeadPose>() = head;
  tracker_->activate();
  const Estimates& estimates = tracker_->output<Estimates>();
  if (!estimates.verdict.usable()) return {{}, estimates.verdict.reason};
  const Track& track = estimates.tracks[0];
  if (!track.measured_now) return {{}, track.reason};
  return {track.T_camera_tool};
}

Result<UncertainPose> GlintChain::followed() const {
  const Estimates& estimates = tracker_->output<Estimates>();
  const Track& track = estimates.tracks[0];
  if (!estimates.verdict.usable()) return {{}, estimates.verdict.reason};
  if (!track.measured_now) return {{}, track.reason};
  if (track.base != ReferenceFrame::world) return {{}, Reason::head_pose_missing};
  UncertainPose tip = pose_of(track.motion);
  const Vector3 arm = tip.pose.rotation * estimates.tips[0].arm_m;
  tip.pose.translation += arm;
  tip.covariance = moved_covariance(tip.covariance + track.head_covariance, arm);
  return {tip};
}

}  // namespace glint
