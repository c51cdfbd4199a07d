// Frame group of a run: activates the tracker on each frame, publishes its estimates to the tick
// group, and offers the inputs of a replay to the recorder.
#pragma once

#include <functional>
#include <memory>

#include "graph/rate_group.hpp"
#include "nodes/tracker.hpp"
#include "platform/cells/cell.hpp"
#include "platform/runtime/session/frame_source.hpp"
#include "platform/runtime/session/group_runner.hpp"
#include "platform/runtime/session/release_records.hpp"
#include "platform/runtime/session/tick_releases.hpp"
#include "platform/sinks/dds/pose_output.hpp"
#include "platform/sinks/record/recorder.hpp"

namespace glint {

using Clock = std::function<Time()>;

// Alternative method from a frame to estimates, instead of the tracker. The caller injects it, so
// that the groups do not depend on its parts.
class FrameMethod {
 public:
  virtual ~FrameMethod() = default;
  // Returns the estimates after this frame; valid until the next call.
  [[nodiscard]] virtual const Estimates& process(const ArrivedFrame& arrived) = 0;
};

// G: Tracker, or MarkerTracker for a recording without pixels.
template <class G>
class FrameGroupOf {
 public:
  // `lane` may be null: nothing is recorded. `tool_set` and `runner` must outlive this object. A
  // `method` replaces the tracker and has no deadline watch.
  FrameGroupOf(const Cell& cell, graph::TripleBuffer<ToolSet>& tool_set, Clock now,
               GroupRunner<G>& runner, RecorderLane* lane,
               std::unique_ptr<FrameMethod> method = nullptr);

  // Publishes the headset's pose to `dds` after each frame's estimates, and the robot's pose if the
  // robot is mounted on the reference body; null: publishes neither.
  void publish_transforms_to(PoseOutput* dds) noexcept { dds_ = dds; }

  // Announces each estimate with a measured tool to `measured` as soon as it is published; null:
  // announces none.
  void announce_to(MeasuredEstimates* measured) noexcept { measured_ = measured; }

  // Publishes the estimates before it offers anything to the recorder: latency first. After an
  // overrun, publishes the policy's substitute. In a replay, `recorded` decides instead of the
  // clock, and the newest published tool set must be the recorded one.
  void process(const ArrivedFrame& arrived, const ChoiceRecord* recorded = nullptr) noexcept;

  [[nodiscard]] graph::TripleBuffer<Estimates>& estimates() noexcept { return estimates_; }
  // Overruns of this group; the tick group reports them over CAN.
  [[nodiscard]] OverrunNotes& overrun_notes() noexcept { return notes_; }
  // The tracker, with its tokens those of the last frame; null: a method or an overrun's policy
  // made the estimates.
  [[nodiscard]] const G* tracker() const noexcept {
    return method_ == nullptr && !overrun_.happened() ? tracker_.get() : nullptr;
  }
  // Estimates of the last frame.
  [[nodiscard]] const Estimates& newest() const noexcept { return *newest_; }

 private:
  void publish() noexcept;
  void publish_substitute(const ArrivedFrame& arrived) noexcept;
  void record(const ArrivedFrame& arrived) noexcept;
  void publish_transforms(const HeadPose& head) const noexcept;

  std::unique_ptr<G> tracker_ = std::make_unique<G>();
  graph::RateGroup<G> group_;
  std::unique_ptr<FrameMethod> method_;  // null: the tracker
  graph::TripleBuffer<Estimates> estimates_;
  // A substitute is computed from the last estimates that were in time. They are not copied for it:
  // they remain in the slot in which they were published. The writer's slot is a different one,
  // since only publish() exchanges slots. At the earliest, publishing the next version gives this
  // slot back to the writer, whichever version the reader takes meanwhile. If the next version is a
  // substitute, they are copied to `last_in_time_copy_` before that, since the next consecutive
  // overrun needs them again.
  std::unique_ptr<Estimates> last_in_time_copy_ = std::make_unique<Estimates>();
  const Estimates* in_time_ = last_in_time_copy_.get();
  const Estimates* newest_ = last_in_time_copy_.get();
  Clock now_;
  GroupRunner<G>* runner_;
  RecorderLane* lane_;
  PoseOutput* dds_ = nullptr;
  MeasuredEstimates* measured_ = nullptr;
  bool robot_on_body_;
  Pose T_body_robot_;  // in the reference body's frame
  Duration lost_after_;
  graph::OverrunDecision overrun_;  // of the last frame
  OverrunNotes notes_;
};

using FrameGroup = FrameGroupOf<Tracker>;

// Instantiated once, in frame_group.cpp.
extern template class GroupRunner<Tracker>;
extern template class GroupRunner<MarkerTracker>;
extern template class FrameGroupOf<Tracker>;
extern template class FrameGroupOf<MarkerTracker>;

}  // namespace glint
