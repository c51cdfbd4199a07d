#include "platform/runtime/session/frame_group.hpp"

#include <algorithm>
#include <string_view>
#include <type_traits>
#include <utility>

#include "graph/describe.hpp"
#include "nodes/overrun_effects.hpp"
#include "platform/runtime/session/pipeline.hpp"

namespace glint {

template class GroupRunner<Tracker>;
template class GroupRunner<MarkerTracker>;
namespace {

// Index of the first node with this name, in the order of execution.
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

// Last node of G that has run if `after_node` is the last one of Tracker that has; -1: none.
template <class G>
int last_node(int after_node) {
  const auto& recorded = graph::Description<Tracker>::nodes;
  const auto end = recorded.begin() + std::min<int>(after_node + 1, Tracker::node_count);
  int last = -1, number = 0;
  for (const graph::NodeInfo& node : graph::Description<G>::nodes) {
    const auto is_same = [&](const graph::NodeInfo& other) {
      return other.name == node.name && other.copy == node.copy;
    };
    if (std::any_of(recorded.begin(), end, is_same)) last = number;
    ++number;
  }
  return last;
}

void set_inputs(const ArrivedFrame& arrived, Tracker& tracker) noexcept {
  tracker.input<Frame>() = arrived.frame;
  tracker.input<HeadPose>() = arrived.head;
}
void set_inputs(const ArrivedFrame& arrived, MarkerTracker& tracker) noexcept {
  FrameStamp& stamp = tracker.input<FrameStamp>();
  stamp = overrun_stamp(arrived.frame);
  stamp.reason = arrived.markers->reason;
  tracker.input<Markers>() = arrived.markers->markers;
  tracker.input<HeadPose>() = arrived.head;
}

}  // namespace

template <class G>
FrameGroupOf<G>::FrameGroupOf(const Cell& cell, graph::TripleBuffer<ToolSet>& tool_set, Clock now,
                              GroupRunner<G>& runner, RecorderLane* lane,
                              std::unique_ptr<FrameMethod> method)
    : group_(*tracker_, k_frame_group),
      method_(std::move(method)),
      now_(std::move(now)),
      runner_(&runner),
      lane_(lane),
      robot_on_body_(cell.robot_valid && cell.robot_in_reference),
      T_body_robot_(cell.T_world_robot),
      lost_after_(cell.lost_after) {
  configure(cell, *tracker_);
  tracker_->template latest<ToolSet>().bind(tool_set);
}

template <class G>
void FrameGroupOf<G>::process(const ArrivedFrame& arrived, const ChoiceRecord* recorded) noexcept {
  if (recorded != nullptr) {
    (void)group_.release_as(as_choice(*recorded));
  } else {
    (void)group_.release(arrived.frame.mid_exposure.nanoseconds);
  }
  if (method_ == nullptr) {
    set_inputs(arrived, *tracker_);
    const std::uint64_t sequence = arrived.frame.sequence;
    overrun_ = recorded != nullptr
                   ? runner_->run_as(*tracker_, recorded->overrun,
                                     last_node<G>(recorded->overrun.after_node))
                   : runner_->run(*tracker_, {group_.choice().activation, sequence,
                                              arrived.frame.arrival, now_(), sequence});
  }
  Estimates& slot = estimates_.write_slot();
  newest_ = &slot;
  if (overrun_.happened()) {
    publish_substitute(arrived);
  } else {
    slot = method_ != nullptr ? method_->process(arrived) : tracker_->template output<Estimates>();
    in_time_ = &slot;
    publish();
  }
  if (method_ == nullptr) runner_->finish_activation(*tracker_);
  publish_transforms(arrived.head);
  if (lane_ != nullptr) record(arrived);
}

template <class G>
void FrameGroupOf<G>::publish() noexcept {
  const MeasuredEstimate published{group_.choice().activation, now_()};
  estimates_.publish(published.version, published.published.nanoseconds);
  if (measured_ != nullptr && !overrun_.happened() && has_measurement(*newest_)) {
    measured_->publish(published);
  }
}

template <class G>
void FrameGroupOf<G>::publish_substitute(const ArrivedFrame& arrived) noexcept {
  const OverrunFrame frame{overrun_stamp(arrived.frame), arrived.head, lost_after_};
  Estimates& slot = estimates_.write_slot();
  if (substitute(overrun_.policy, frame, *in_time_, slot)) {
    if (in_time_ != last_in_time_copy_.get()) *last_in_time_copy_ = *in_time_;
    in_time_ = last_in_time_copy_.get();
    publish();
  } else {  // the slot remains the writer's, which overwrites it for the next version
    slot.tool_count = 0;
    slot.verdict.reason = reason_of(overrun_.policy);
  }
  (void)notes_.push({k_frame_group, overrun_});  // full: the choice has it too
}

template <class G>
void FrameGroupOf<G>::publish_transforms(const HeadPose& head) const noexcept {
  if (dds_ == nullptr) return;
  const bool known = robot_on_body_ && newest_->has_reference;
  (void)dds_->offer_frame(
      {head, known, known ? newest_->T_world_reference * T_body_robot_ : Pose{}});
}

template <class G>
void FrameGroupOf<G>::record(const ArrivedFrame& arrived) noexcept {
  if constexpr (std::is_same_v<G, Tracker>) {  // a replay of markers does not record
    const auto ran = [&](int node) { return !overrun_.happened() || overrun_.after_node >= node; };
    (void)lane_->offer_head_pose(arrived.head);
    ChoiceRecord choice = as_record(group_.choice(), 0);
    choice.overrun = overrun_;
    (void)lane_->offer_choice(choice);
    // The frame comes last: then a replay has all inputs of the activation. The recording's level
    // omits either the frame or its markers. Data that was not computed for this frame is left
    // empty.
    (void)lane_->offer_frame(arrived.frame,
                             ran(k_locate_rois) ? tracker_->template token<Rois>() : Rois{});
    MarkerFrame markers;
    markers.mid_exposure = arrived.frame.mid_exposure;
    markers.stamp_sigma = arrived.frame.stamp_sigma;
    markers.arrival = arrived.frame.arrival;
    markers.sequence = arrived.frame.sequence;
    markers.reason = tracker_->template token<FrameStamp>().reason;
    if (ran(k_back_project)) markers.markers = tracker_->template token<Markers>();
    (void)lane_->offer_markers(markers);
    const Reason dropped = overrun_.happened() ? reason_of(overrun_.policy)
                                               : tracker_->template token<FrameVerdict>().reason;
    if (dropped != Reason::none) {
      (void)lane_->offer_dropped(
          {arrived.frame.mid_exposure, arrived.frame.arrival, arrived.frame.sequence, dropped});
    }
  }
}

template class FrameGroupOf<Tracker>;
template class FrameGroupOf<MarkerTracker>;

}  // namespace glint
