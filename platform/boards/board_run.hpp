// A run on a board: frames from memory at the camera's rate, ticks by the clock, poses to CAN and,
// if asked for, to DDS and into a recording; a cell's background beneath. Real time on one core.
#pragma once

#include <atomic>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "platform/boards/frame_loop.hpp"
#include "platform/cells/cell.hpp"
#include "platform/session/background_group.hpp"
#include "platform/session/group_runner.hpp"
#include "platform/session/latency.hpp"
#include "platform/session/sent_ticks.hpp"
#include "platform/session/sink_outcome.hpp"

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

struct BoardResult {
  std::int64_t frames = 0;
  std::int64_t frames_worst = 0;    // of these, drawn as worst inputs
  std::int64_t frames_tracked = 0;  // of these, with at least one tool seen
  std::int64_t ticks = 0, ticks_late = 0, ticks_skipped = 0;
  OverrunCounts frame_overruns, tick_overruns;
  std::vector<FrameToCan> latencies;
  TicksLeft sent;  // the ticks that left over CAN
  std::int64_t latencies_left_out = 0;
  std::vector<std::int64_t> frame_wake_up_ns, tick_wake_up_ns;  // the newest, and the largest
  std::uint64_t heap_allocations = 0;                           // of all groups after their start
  bool heap_counted = false;
  std::uint64_t page_faults = 0;               // of all groups after their start, minor and major
  std::optional<BackgroundCounts> background;  // where the cell has one
  std::uint64_t can_frames = 0;
  SinkOutcome sinks;
  std::string output_sha256;         // over the output records
  std::string decision_sha256;       // over every tick's states and every frame's verdict
  std::vector<std::string> refused;  // rights that the system did not grant
};

// Throws InputError for what a board does not run (board_checks.hpp), for depth pictures or a model
// that cannot be read, and for a recording that cannot be made; MissingDevice.
[[nodiscard]] BoardResult run_board(Cell cell, const FrameLoop& loop, const BoardOptions& options);

}  // namespace glint
