// Short run with button events in simulated order, so that every run is identical: each event is
// offered before the first tick at or after its time.
#pragma once

#include <memory>
#include <vector>

#include "platform/runtime/session/release_order.hpp"
#include "platform/runtime/session/session_groups.hpp"
#include "platform/sources/simulated_source.hpp"
#include "tests/unit/platform/runtime/session/short_run.hpp"

namespace glint {

inline SessionResult run_with_buttons(const Cell& cell, const std::vector<ButtonEvent>& events,
                                      SessionOptions options) {
  const sim::Simulator simulator(scenario_of(cell));
  options.plan = schedule_by_rule(cell);
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
  const auto on_tick = [&](const NextRelease& release) {
    now = release.nominal;
    for (; event != events.end() && event->time <= now; ++event) sinks.offer_button(*event);
    groups->tick(release.tick, now, now);
    ++result.ticks;
  };
  const auto on_frame = [&](const NextRelease& release) {
    now = release.nominal;
    groups->apply_changes(now);
    groups->process(*release.frame);
  };
  NominalOrder order(cell, source, groups->measured(), nullptr);
  run_releases(order, on_frame, on_tick);
  groups->report(result);
  sinks.close(result);
  return result;
}

}  // namespace glint
