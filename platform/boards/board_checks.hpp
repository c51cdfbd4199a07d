// What a board does not run is refused before it starts: otherwise it would run less than was asked
// for.
#pragma once

#include "platform/boards/frame_loop.hpp"
#include "platform/cells/cell.hpp"

namespace glint {

// Throws InputError where the cell changes tools.
void check_for_board(const Cell& cell);
// Throws InputError where the loop's frames are not the cell's camera's.
void check_camera(const Cell& cell, const FrameLoop& loop);

}  // namespace glint
