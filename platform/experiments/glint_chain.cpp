#include "platform/experiments/glint_chain.hpp"

#include "platform/session/pipeline.hpp"

namespace glint {

GlintChain::GlintChain(const Camera& camera, const Tool& tool, SearchArea area)
    : tracker_(std::make_unique<Tracker>()) {
  Cell cell = default_cell();
  set_camera(cell, camera);
  cell.tools.items[0] = tool;
  cell.tools.count = 1;
  configure(cell, *tracker_);
  if (area == SearchArea::whole_frame)
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
  if (!track.seen_now) return {{}, track.reason};
  return {track.T_camera_tool};
}

}  // namespace glint
