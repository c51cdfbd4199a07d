// Run on simulated frames, with the simulator's additional dependency: PNG images.
#pragma once

#include "platform/runtime/session/session.hpp"
#include "platform/sim/scenario.hpp"

namespace glint {

// Adds what only a desktop has: depth images as PNG.
[[nodiscard]] SessionOptions with_desktop_parts(SessionOptions options);

// Runs the scenario of the cell, or the given one (its camera is the cell's). The source needs
// `frame_time` for each frame after it is due: a slow source, for tests. Throws as run_session().
[[nodiscard]] SessionResult run_simulated(const Cell& cell, const SessionOptions& options,
                                          Duration frame_time = {});
[[nodiscard]] SessionResult run_simulated(const Cell& cell, sim::Scenario scenario,
                                          const SessionOptions& options, Duration frame_time = {});

// Runs on the frames of the cell's [source]: `source` is open_source()'s; null: the simulator.
[[nodiscard]] SessionResult run_source(const Cell& cell, FrameSource* source,
                                       const SessionOptions& options, Duration frame_time = {});

}  // namespace glint
