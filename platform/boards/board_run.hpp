// A run on a board: frames from memory at the camera's rate, or live ones, ticks by the clock,
// poses to CAN and, if asked for, to DDS and into a recording; a cell's background beneath. Real
// time on one core.
#pragma once

#include <atomic>
#include <cstdint>
#include <string>
#include <vector>

#include "platform/boards/frame_loop.hpp"
#include "platform/cells/cell.hpp"
#include "platform/session/frame_source.hpp"
#include "platform/session/session.hpp"

namespace glint {

// What each node may need at worst, by its number in the order of execution; empty: unknown, and an
// overrun is noticed only when the deadline has passed.
struct BoardBounds {
  std::vector<std::int64_t> frame_ns, tick_ns;
};

struct BoardOptions {
  std::int64_t frames = 1000;               // 0: until `stop`
  const std::atomic<bool>* stop = nullptr;  // set: the run ends here, whole as far as it went
  int core = -1;                            // all threads of the run on this core; -1: on any
  std::string out = ".";  // folder of a CAN log, where the cell names one, and of the recording
  std::string record;     // a file, at the cell's [record] level; empty: nothing is recorded
  BoardBounds bounds;
};

struct BoardResult : SessionResult {
  std::int64_t frames_worst = 0;               // of the frames, drawn as worst inputs
  std::vector<std::int64_t> frame_wake_up_ns;  // the newest, and the largest
};

// One worker a group, all on one core, in the graphs' order.
[[nodiscard]] RunPlan plan_on_one_core(Cell cell, int core, const BoardBounds& bounds);

// On the frames of a live source, of the cell's camera; its own settings say when it ends. Throws
// InputError for what a board does not run (board_checks.hpp), for depth pictures or a model that
// cannot be read, and for a recording that cannot be made; MissingDevice.
[[nodiscard]] BoardResult run_board(Cell cell, FrameSource& source, const BoardOptions& options);
// On a loop of frames, as a camera of that period.
[[nodiscard]] BoardResult run_board(Cell cell, const FrameLoop& loop, const BoardOptions& options);

}  // namespace glint
