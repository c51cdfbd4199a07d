// The frame group as it runs: a frame goes in, the tracker is activated, its estimates are
// published to the tick group, and what a replay needs is offered to the recorder.
#pragma once

#include <functional>
#include <memory>

#include "graph/rate_group.hpp"
#include "nodes/tracker.hpp"
#include "platform/cells/cell.hpp"
#include "platform/dds/dds_sink.hpp"
#include "platform/record/recorder.hpp"
#include "platform/session/choices.hpp"
#include "platform/session/frame_source.hpp"
#include "platform/session/group_runner.hpp"

namespace glint {

using Clock = std::function<Time()>;

// Another way from a frame to estimates, in the tracker's place: the caller hands it in, so that
// the groups need none of what it is built from.
class FrameMethod {
 public:
  virtual ~FrameMethod() = default;
  // What is known after this frame; valid until the next call.
  [[nodiscard]] virtual const Estimates& process(const ArrivedFrame& arrived) = 0;
};

// G: Tracker, or MarkerTracker for a recording without pixels.
template <class G>
class FrameGroupOf {
 public:
  // `lane` may be null: nothing is recorded. `tool_set` and `runner` outlive this. With a `method`
  // it decides in the tracker's place, unwatched.
  FrameGroupOf(const Cell& cell, graph::TripleBuffer<ToolSet>& tool_set, Clock now,
               GroupRunner<G>& runner, RecorderLane* lane,
               std::unique_ptr<FrameMethod> method = nullptr);

  // Where the headset is goes there, too, after each frame's estimates, and where the robot is
  // that stands on the reference body; null: nowhere.
  void tell_transforms_to(DdsSink* dds) noexcept { dds_ = dds; }

  // Estimates are published before anything is offered: latency first. Of a frame that was not in
  // time, what the policy says is published. In a replay `recorded` decides in place of the clock;
  // the newest set of tools that was published is the recorded one.
  void process(const ArrivedFrame& arrived, const ChoiceRecord* recorded = nullptr) noexcept;

  [[nodiscard]] graph::TripleBuffer<Estimates>& estimates() noexcept { return estimates_; }
  // The overruns that somebody has to tell the world: the tick group, by CAN.
  [[nodiscard]] OverrunNotes& overrun_notes() noexcept { return notes_; }
  // The tracker, its tokens those of the last frame; null: a method or an overrun's policy made the
  // estimates.
  [[nodiscard]] const G* tracker() const noexcept {
    return method_ == nullptr && !overrun_.happened() ? tracker_.get() : nullptr;
  }
  // What the last frame left.
  [[nodiscard]] const Estimates& newest() const noexcept { return *newest_; }

 private:
  void publish() noexcept;
  void answer(const ArrivedFrame& arrived) noexcept;
  void record(const ArrivedFrame& arrived) noexcept;
  void tell_transforms(const HeadPose& head) const noexcept;

  std::unique_ptr<G> tracker_ = std::make_unique<G>();
  graph::RateGroup<G> group_;
  std::unique_ptr<FrameMethod> method_;  // null: the tracker
  graph::TripleBuffer<Estimates> estimates_;
  // A substitute rests on the last estimates that were in time, which are not copied for it: they
  // stay as they are in the slot in which they were published. The writer's slot is another one
  // then, and only publish() gives the writer a slot: this one at the earliest when the next
  // version has been published, whatever the reader takes meanwhile. Before that they are copied to
  // `kept_` if the next version is a substitute, since the next overrun in a row needs them again.
  std::unique_ptr<Estimates> kept_ = std::make_unique<Estimates>();
  const Estimates* in_time_ = kept_.get();
  const Estimates* newest_ = kept_.get();
  Clock now_;
  GroupRunner<G>* runner_;
  RecorderLane* lane_;
  DdsSink* dds_ = nullptr;
  bool robot_on_body_;
  Pose T_body_robot_;  // the reference body's
  Duration lost_after_;
  graph::OverrunDecision overrun_;  // of the last frame
  OverrunNotes notes_;
};

using FrameGroup = FrameGroupOf<Tracker>;

// In frame_group.cpp, once.
extern template class GroupRunner<Tracker>;
extern template class GroupRunner<MarkerTracker>;
extern template class FrameGroupOf<Tracker>;
extern template class FrameGroupOf<MarkerTracker>;

}  // namespace glint
