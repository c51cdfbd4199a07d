// A run on simulated frames, with what the simulator needs beside it: the published method, and
// pictures as PNG.
#pragma once

#include "platform/session/session.hpp"
#include "platform/sim/scenario.hpp"

namespace glint {

// `options` with what only a desktop has: the published method, and depth pictures as PNG.
[[nodiscard]] SessionOptions with_desktop_parts(SessionOptions options);

// Of the scenario that the cell asks for, or of one's own (its camera is the cell's). The source
// needs `frame_time` for each frame from when it is due: a slow one, for tests. Throws as
// run_session() does.
[[nodiscard]] SessionResult run_simulated(const Cell& cell, const SessionOptions& options,
                                          Duration frame_time = {});
[[nodiscard]] SessionResult run_simulated(const Cell& cell, sim::Scenario scenario,
                                          const SessionOptions& options, Duration frame_time = {});

// On the frames that a cell's [source] names: `source` is open_source()'s, null for the simulator.
[[nodiscard]] SessionResult run_source(const Cell& cell, FrameSource* source,
                                       const SessionOptions& options, Duration frame_time = {});

}  // namespace glint
