// Real-time run on one core of a companion computer. Frames from memory at the camera's rate, or
// live; ticks by the clock; poses to CAN and, on request, to DDS and into a recording; the cell's
// background group below.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "platform/apps/board/frame_loop.hpp"
#include "platform/cells/cell.hpp"
#include "platform/runtime/rt/service_notifier.hpp"
#include "platform/runtime/session/frame_source.hpp"
#include "platform/runtime/session/session.hpp"

namespace glint {

// Worst-case execution time by node, in the order of execution. Empty: unknown; an overrun is then
// detected only after the deadline.
struct NodeWcets {
  std::vector<std::int64_t> frame_ns, tick_ns;
};

struct CompanionOptions {
  std::int64_t frames = 1000;               // 0: until `stop`
  const std::atomic<bool>* stop = nullptr;  // set: ends the run here, with complete results so far
  int core = -1;                            // core for all threads of the run; -1: any
  std::string out = ".";  // folder of a CAN log, if the cell names one, and of the recording
  std::string record;     // file, at the cell's [record] level; empty: no recording
  NodeWcets bounds;
  ServiceNotifier* service = nullptr;  // see SessionOptions
  std::function<bool()> enabled;       // likewise
};

struct CompanionResult : SessionResult {
  std::int64_t frames_worst = 0;               // number of frames that are worst-case inputs
  std::vector<std::int64_t> frame_wake_up_ns;  // the newest, and the largest
};

// Schedule with one worker per group, all on one core, in the graphs' order.
[[nodiscard]] RunSchedule schedule_on_one_core(Cell cell, int core, const NodeWcets& bounds);

// Runs on a live source with the cell's camera; the source's settings determine the end. Throws
// InputError for a cell that a companion computer does not run (board_checks.hpp), for depth images
// or a model that cannot be read, and for a recording that cannot be created; MissingDevice.
[[nodiscard]] CompanionResult run_companion(Cell cell, FrameSource& source,
                                            const CompanionOptions& options);
// Runs on a loop of frames, like a camera with the loop's period.
[[nodiscard]] CompanionResult run_companion(Cell cell, const FrameLoop& loop,
                                            const CompanionOptions& options);

}  // namespace glint
