// A run on the frames that a cell's [source] names.
#pragma once

#include "platform/session/frame_source.hpp"
#include "platform/session/session.hpp"

namespace glint {

// `source`: of open_source(), null for the simulator, which then needs `frame_time` for each frame:
// a slow source, for tests. Throws as run_session() does.
[[nodiscard]] SessionResult run_source(const Cell& cell, FrameSource* source,
                                       const SessionOptions& options, Duration frame_time = {});

}  // namespace glint
