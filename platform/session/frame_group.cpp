#include "platform/session/frame_group.hpp"

#include <utility>

#include "graph/describe.hpp"
#include "nodes/overrun_effects.hpp"
#include "platform/session/pipeline.hpp"

namespace glint {

template class GroupRunner<Tracker>;
namespace {

// The first node of a kind, by its number in the order of execution.
constexpr int number_of(std::string_view name) {
  int number = 0;
  for (const graph::NodeInfo& node : graph::Description<Tracker>::nodes) {
    if (node.name == name) return number;
    ++number;
  }
  return -1;
}
constexpr int k_locate_rois = number_of("LocateRois");
constexpr int k_back_project = number_of("BackProject");
static_assert(k_locate_rois > 0 && k_back_project > k_locate_rois);

}  // namespace

FrameGroup::FrameGroup(const Cell& cell, graph::TripleBuffer<ToolSet>& tool_set, Clock now,
                       GroupRunner<Tracker>& runner, RecorderLane* lane,
                       std::unique_ptr<FrameMethod> method)
    : group_(*tracker_, k_frame_group),
      method_(std::move(method)),
      newest_(&tracker_->output<Estimates>()),
      now_(std::move(now)),
      runner_(&runner),
      lane_(lane),
      robot_on_body_(cell.robot_given && cell.robot_in_reference),
      T_body_robot_(cell.T_world_robot),
      lost_after_(cell.lost_after) {
  configure(cell, *tracker_);
  tracker_->latest<ToolSet>().bind(tool_set);
}

void FrameGroup::process(const ArrivedFrame& arrived) noexcept {
  (void)group_.release(arrived.frame.mid_exposure.nanoseconds);
  if (method_ != nullptr) {
    newest_ = &method_->process(arrived);
    publish(*newest_);
    tell_transforms(arrived.head);
    if (lane_ != nullptr) record(arrived);
    return;
  }
  tracker_->input<Frame>() = arrived.frame;
  tracker_->input<HeadPose>() = arrived.head;
  overrun_ = runner_->run(*tracker_, {group_.choice().activation, arrived.frame.sequence,
                                      arrived.frame.arrival, now_(), arrived.frame.sequence});
  if (overrun_.happened()) {
    answer(arrived);
  } else {
    newest_ = &tracker_->output<Estimates>();
    publish(*newest_);
  }
  runner_->settle(*tracker_);
  if (!overrun_.happened()) *in_time_ = *newest_;
  tell_transforms(arrived.head);
  if (lane_ != nullptr) record(arrived);
}

void FrameGroup::publish(const Estimates& estimates) noexcept {
  estimates_.write_slot() = estimates;
  estimates_.publish(group_.choice().activation, now_().nanoseconds);
}

void FrameGroup::answer(const ArrivedFrame& arrived) noexcept {
  const OverrunFrame frame{overrun_stamp(arrived.frame), arrived.head, lost_after_};
  if (substitute(overrun_.policy, frame, *in_time_, *substitute_)) {
    publish(*substitute_);
  } else {
    substitute_->tool_count = 0;
    substitute_->verdict.reason = reason_of(overrun_.policy);
  }
  newest_ = substitute_.get();
  (void)notes_.push({k_frame_group, overrun_});  // full: the choice records it all the same
}

void FrameGroup::tell_transforms(const HeadPose& head) const noexcept {
  if (dds_ == nullptr) return;
  const bool known = robot_on_body_ && newest_->reference_known;
  (void)dds_->offer_frame(
      {head, known, known ? newest_->T_world_reference * T_body_robot_ : Pose{}});
}

void FrameGroup::record(const ArrivedFrame& arrived) noexcept {
  const auto ran = [&](int node) { return !overrun_.happened() || overrun_.after_node >= node; };
  const FrameVerdict& verdict = tracker_->token<FrameVerdict>();
  (void)lane_->offer_head_pose(arrived.head);
  ChoiceRecord choice = as_record(group_.choice(), 0);
  choice.overrun = overrun_;
  (void)lane_->offer_choice(choice);
  // The frame comes last: with it a replay has all that the activation was given. The one or the
  // other is left out by the recording's level. What was not computed for this frame is not there.
  (void)lane_->offer_frame(arrived.frame, ran(k_locate_rois) ? tracker_->token<Rois>() : Rois{});
  MarkerFrame markers;
  markers.mid_exposure = arrived.frame.mid_exposure;
  markers.arrival = arrived.frame.arrival;
  markers.sequence = arrived.frame.sequence;
  markers.reason = tracker_->token<FrameStamp>().reason;
  if (ran(k_back_project)) markers.markers = tracker_->token<Markers>();
  (void)lane_->offer_markers(markers);
  const Reason dropped = overrun_.happened() ? reason_of(overrun_.policy) : verdict.reason;
  if (dropped != Reason::none) {
    (void)lane_->offer_dropped(
        {arrived.frame.mid_exposure, arrived.frame.arrival, arrived.frame.sequence, dropped});
  }
}

}  // namespace glint
