#include "platform/session/source_run.hpp"

#include "platform/session/simulated_run.hpp"

namespace glint {

SessionResult run_source(const Cell& cell, FrameSource* source, const SessionOptions& options,
                         Duration frame_time) {
  if (source == nullptr) return run_simulated(cell, options, frame_time);
  return run_session(cell, *source, with_desktop_parts(options));
}

}  // namespace glint
