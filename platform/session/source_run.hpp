// A run on the frames that a cell's [source] names.
#pragma once

#include "platform/record/recording_reader.hpp"
#include "platform/session/session.hpp"

namespace glint {

struct SourceOptions {
  Duration frame_time;      // the simulator needs so long for each frame: a slow source, for tests
  ReadTolerance tolerance;  // of a recording
};

// Throws as run_session() and open_recorded() do.
[[nodiscard]] SessionResult run_source(const Cell& cell, const SessionOptions& options,
                                       const SourceOptions& source = {});

}  // namespace glint
