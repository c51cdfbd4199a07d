#include "platform/session/frame_group.hpp"

#include <utility>

#include "platform/session/pipeline.hpp"

namespace glint {

FrameGroup::FrameGroup(const Cell& cell, graph::TripleBuffer<ToolSet>& tool_set, Clock now,
                       Activate activate, RecorderLane* lane, std::unique_ptr<FrameMethod> method)
    : group_(*tracker_, k_frame_group),
      method_(std::move(method)),
      newest_(&tracker_->output<Estimates>()),
      now_(std::move(now)),
      activate_(std::move(activate)),
      lane_(lane) {
  configure(cell, *tracker_);
  tracker_->latest<ToolSet>().bind(tool_set);
}

void FrameGroup::process(const ArrivedFrame& arrived) noexcept {
  (void)group_.release(arrived.frame.mid_exposure.nanoseconds);
  newest_ = &estimate(arrived);
  estimates_.write_slot() = *newest_;
  estimates_.publish(group_.choice().activation, now_().nanoseconds);
  if (lane_ != nullptr) record(arrived);
}

const Estimates& FrameGroup::estimate(const ArrivedFrame& arrived) noexcept {
  if (method_ != nullptr) return method_->process(arrived);
  tracker_->input<Frame>() = arrived.frame;
  tracker_->input<HeadPose>() = arrived.head;
  activate_(*tracker_);
  return tracker_->output<Estimates>();
}

void FrameGroup::record(const ArrivedFrame& arrived) noexcept {
  const FrameVerdict& verdict = tracker_->token<FrameVerdict>();
  (void)lane_->offer_head_pose(arrived.head);
  (void)lane_->offer_choice(as_record(group_.choice(), 0));
  // The frame comes last: with it a replay has all that the activation was given. The one or the
  // other is left out by the recording's level.
  (void)lane_->offer_frame(arrived.frame, tracker_->token<Rois>());
  MarkerFrame markers;
  markers.mid_exposure = arrived.frame.mid_exposure;
  markers.arrival = arrived.frame.arrival;
  markers.sequence = arrived.frame.sequence;
  markers.reason = tracker_->token<FrameStamp>().reason;
  markers.markers = tracker_->token<Markers>();
  (void)lane_->offer_markers(markers);
  if (!verdict.usable()) {
    (void)lane_->offer_dropped({arrived.frame.mid_exposure, arrived.frame.arrival,
                                arrived.frame.sequence, verdict.reason});
  }
}

}  // namespace glint
