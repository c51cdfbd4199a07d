#include "platform/runtime/session/simulated_run.hpp"

#include <utility>

#include "platform/sources/scenario_of.hpp"
#include "platform/sources/simulated_source.hpp"
#include "platform/tools/mapping/depth_png.hpp"

namespace glint {

SessionOptions with_desktop_parts(SessionOptions options) {
  options.read_png = read_depth_png;
  return options;
}

SessionResult run_simulated(const Cell& cell, const SessionOptions& options, Duration frame_time) {
  return run_simulated(cell, scenario_of(cell), options, frame_time);
}

SessionResult run_simulated(const Cell& cell, sim::Scenario scenario, const SessionOptions& given,
                            Duration frame_time) {
  const sim::Simulator simulator(std::move(scenario));
  SimulatedSource source(simulator, {cell.realtime, frame_time});
  return run_session(cell, source, with_desktop_parts(given));
}

SessionResult run_source(const Cell& cell, FrameSource* source, const SessionOptions& options,
                         Duration frame_time) {
  if (source == nullptr) return run_simulated(cell, options, frame_time);
  return run_session(cell, *source, with_desktop_parts(options));
}

}  // namespace glint
