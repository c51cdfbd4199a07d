// A tick group with one tool that no frame has shown; it still publishes at every tick.
#pragma once

#include <cstdint>

#include "platform/runtime/session/sinks.hpp"
#include "platform/runtime/session/tick_group.hpp"

namespace glint {

class TickGroupWithoutFrames {
 public:
  // `tick_sinks`: the sinks that receive the ticks.
  TickGroupWithoutFrames(const Cell& cell, Sinks& sinks, const TickSinks& tick_sinks)
      : runner_(in_order()),
        group_(
            cell, estimates_, robot_, sinks.held_buttons(), [this] { return now_; }, tick_sinks, 0,
            1, runner_, notes_) {
    estimates_.write_slot().tool_count = 1;
    estimates_.publish(1, 0);
  }

  void tick() {
    now_ = Time{} + milliseconds(4) * number_;
    group_.tick(number_++, now_, now_);
  }
  // Time of the last tick.
  [[nodiscard]] Time now() const { return now_; }

 private:
  static RunnerSettings<Output> in_order() {
    RunnerSettings<Output> settings;
    settings.live = false;
    return settings;
  }

  graph::TripleBuffer<Estimates> estimates_;
  graph::TripleBuffer<RobotFrame> robot_;
  GroupRunner<Output> runner_;
  OverrunNotes notes_;
  Time now_;
  std::uint32_t number_ = 0;
  TickGroup group_;
};

}  // namespace glint
