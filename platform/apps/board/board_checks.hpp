// Checks of a cell and a loop before a run on the companion computer. Rejects what it cannot run,
// instead of running less than requested.
#pragma once

#include "platform/apps/board/frame_loop.hpp"
#include "platform/cells/cell.hpp"

namespace glint {

// Throws InputError if the cell changes its tools during a run.
void check_for_companion(const Cell& cell);
// Throws InputError if the loop's frames do not have the format of the cell's camera.
void check_camera(const Cell& cell, const FrameLoop& loop);

}  // namespace glint
