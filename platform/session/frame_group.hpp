// The frame group as it runs: a frame goes in, the tracker is activated, its estimates are
// published to the tick group, and what a replay needs is offered to the recorder.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>

#include "graph/rate_group.hpp"
#include "nodes/tracker.hpp"
#include "platform/cells/cell.hpp"
#include "platform/record/recorder.hpp"
#include "platform/session/choices.hpp"
#include "platform/session/frame_method.hpp"

namespace glint {

using Clock = std::function<Time()>;
using Activate = std::function<void(Tracker&)>;  // by one worker or by several: equal bytes

class FrameGroup {
 public:
  // `lane` may be null: nothing is recorded. `tool_set` outlives this. With a `method` it decides
  // in the tracker's place.
  FrameGroup(const Cell& cell, graph::TripleBuffer<ToolSet>& tool_set, Clock now, Activate activate,
             RecorderLane* lane, std::unique_ptr<FrameMethod> method = nullptr);

  // Estimates are published before anything is offered: latency first.
  void process(const ArrivedFrame& arrived) noexcept;

  [[nodiscard]] graph::TripleBuffer<Estimates>& estimates() noexcept { return estimates_; }
  // What the last frame left.
  [[nodiscard]] const Estimates& newest() const noexcept { return *newest_; }
  [[nodiscard]] std::uint64_t activations() const noexcept { return group_.choice().activation; }

 private:
  [[nodiscard]] const Estimates& estimate(const ArrivedFrame& arrived) noexcept;
  void record(const ArrivedFrame& arrived) noexcept;

  std::unique_ptr<Tracker> tracker_ = std::make_unique<Tracker>();
  graph::RateGroup<Tracker> group_;
  std::unique_ptr<FrameMethod> method_;  // null: the tracker
  const Estimates* newest_;
  graph::TripleBuffer<Estimates> estimates_;
  Clock now_;
  Activate activate_;
  RecorderLane* lane_;
};

}  // namespace glint
