// A short run in which the pen's buttons go down and up, in order and thus the same every time:
// each event is offered before the first tick that is not before it.
#pragma once

#include <memory>
#include <vector>

#include "platform/session/session_groups.hpp"
#include "platform/session/simulated_source.hpp"
#include "tests/unit/platform/session/short_run.hpp"

namespace glint {

inline SessionResult run_with_buttons(const Cell& cell, const std::vector<ButtonEvent>& events,
                                      SessionOptions options) {
  const sim::Simulator simulator(scenario_of(cell));
  const Duration period{static_cast<std::int64_t>(1e9 / cell.tick_hz)};
  options.plan = plan_by_rule(cell);
  Time now;
  const Clock clock = [&now] { return now; };
  Sinks sinks(cell, options, 0);
  SimulatedSource source(simulator);
  source.start({false, Time{}, clock});
  const auto groups = std::make_unique<SessionGroups>(
      cell, options, KeptFrames{source.frame_count(), source.frame_count()}, sinks, nullptr, clock,
      0, BackgroundScene{});
  SessionResult result;
  auto event = events.begin();
  const auto tick_until = [&](Time limit) {
    for (Time tick = Time{} + period * result.ticks; tick < limit; tick = tick + period) {
      now = tick;
      for (; event != events.end() && event->time <= tick; ++event) sinks.offer_button(*event);
      groups->tick(static_cast<std::uint32_t>(result.ticks++), tick, tick);
    }
  };
  ArrivedFrame arrived;
  Time last;
  while (source.wait(arrived)) {
    tick_until(arrived.frame.arrival);
    now = last = arrived.frame.arrival;
    groups->reach(now);
    groups->process(arrived);
    source.give_back(arrived);
  }
  tick_until(last + cell.lost_after);
  groups->report(result);
  sinks.close(result);
  return result;
}

}  // namespace glint
