#include "platform/session/source_run.hpp"

#include "platform/session/simulated_run.hpp"
#include "platform/sources/open_source.hpp"

namespace glint {

SessionResult run_source(const Cell& cell, const SessionOptions& options,
                         const SourceOptions& source) {
  if (cell.source.kind == "simulator") return run_simulated(cell, options, source.frame_time);
  const auto recorded = open_recorded(cell, source.tolerance);
  return run_session(cell, *recorded, with_desktop_parts(options));
}

}  // namespace glint
