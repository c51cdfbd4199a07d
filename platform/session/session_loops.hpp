// The loops of a run: what is done when, by which thread. Every run uses one of the two.
#pragma once

#include "platform/cells/cell.hpp"
#include "platform/session/frame_source.hpp"
#include "platform/session/session.hpp"
#include "platform/session/session_groups.hpp"

namespace glint {

// Frames when they arrive, ticks and slices by the clock, which starts at `epoch`, each group in a
// thread of its own. Ticks go on until the last frame's poses are lost, or until the run is
// stopped.
void run_live(const Cell& cell, Time epoch, FrameSource& source, SessionGroups& groups,
              const SessionOptions& options, SessionResult& result);

// Frames, ticks and slices in the order of their nominal times, in one thread: the same bytes every
// time. `now` is the groups' clock.
void run_in_order(const Cell& cell, Time& now, FrameSource& source, SessionGroups& groups,
                  const SessionOptions& options, SessionResult& result);

}  // namespace glint
