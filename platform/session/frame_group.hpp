// The frame group as it runs: a frame goes in, the tracker is activated, its estimates are
// published to the tick group, and what a replay needs is offered to the recorder.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>

#include "graph/rate_group.hpp"
#include "nodes/tracker.hpp"
#include "platform/cells/cell.hpp"
#include "platform/dds/dds_sink.hpp"
#include "platform/record/recorder.hpp"
#include "platform/session/choices.hpp"
#include "platform/session/frame_method.hpp"
#include "platform/session/group_runner.hpp"

namespace glint {

extern template class GroupRunner<Tracker>;  // in frame_group.cpp, once

using Clock = std::function<Time()>;

class FrameGroup {
 public:
  // `lane` may be null: nothing is recorded. `tool_set` and `runner` outlive this. With a `method`
  // it decides in the tracker's place, unwatched.
  FrameGroup(const Cell& cell, graph::TripleBuffer<ToolSet>& tool_set, Clock now,
             GroupRunner<Tracker>& runner, RecorderLane* lane,
             std::unique_ptr<FrameMethod> method = nullptr);

  // Where the headset is goes there, too, after each frame's estimates, and where the robot is
  // that stands on the reference body; null: nowhere.
  void tell_transforms_to(DdsSink* dds) noexcept { dds_ = dds; }

  // Estimates are published before anything is offered: latency first. Of a frame that was not in
  // time, what the policy says is published.
  void process(const ArrivedFrame& arrived) noexcept;

  [[nodiscard]] graph::TripleBuffer<Estimates>& estimates() noexcept { return estimates_; }
  // The overruns that somebody has to tell the world: the tick group, by CAN.
  [[nodiscard]] OverrunNotes& overrun_notes() noexcept { return notes_; }
  // The tracker, its tokens those of the last frame; null: a method or an overrun's policy made the
  // estimates.
  [[nodiscard]] const Tracker* tracker() const noexcept {
    return method_ == nullptr && !overrun_.happened() ? tracker_.get() : nullptr;
  }
  // What the last frame left.
  [[nodiscard]] const Estimates& newest() const noexcept { return *newest_; }
  [[nodiscard]] std::uint64_t activations() const noexcept { return group_.choice().activation; }

 private:
  void publish(const Estimates& estimates) noexcept;
  void answer(const ArrivedFrame& arrived) noexcept;
  void record(const ArrivedFrame& arrived) noexcept;
  void tell_transforms(const HeadPose& head) const noexcept;

  std::unique_ptr<Tracker> tracker_ = std::make_unique<Tracker>();
  graph::RateGroup<Tracker> group_;
  std::unique_ptr<FrameMethod> method_;  // null: the tracker
  const Estimates* newest_;
  graph::TripleBuffer<Estimates> estimates_;
  Clock now_;
  GroupRunner<Tracker>* runner_;
  RecorderLane* lane_;
  DdsSink* dds_ = nullptr;
  bool robot_on_body_;
  Pose T_body_robot_;  // the reference body's
  Duration lost_after_;
  graph::OverrunDecision overrun_;  // of the last frame
  std::unique_ptr<Estimates> in_time_ = std::make_unique<Estimates>();
  std::unique_ptr<Estimates> substitute_ = std::make_unique<Estimates>();
  OverrunNotes notes_;
};

}  // namespace glint
