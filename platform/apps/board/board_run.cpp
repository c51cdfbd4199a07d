#include "platform/apps/board/board_run.hpp"

#include <utility>

#include "platform/apps/board/board_checks.hpp"
#include "platform/apps/board/loop_source.hpp"

namespace glint {

RunPlan plan_on_one_core(Cell cell, int core, const BoardBounds& bounds) {
  cell.workers = 1;
  RunPlan plan = plan_by_rule(cell);
  plan.planned = true;
  plan.frame.cores = plan.tick.cores = {core};
  plan.frame.remaining_ns = remaining_in_order(bounds.frame_ns);
  plan.tick.remaining_ns = remaining_in_order(bounds.tick_ns);
  if (plan.background) plan.background->cores = {core};
  return plan;
}

BoardResult run_board(Cell cell, FrameSource& source, const BoardOptions& options) {
  check_for_board(cell);
  cell.realtime = true;
  cell.record.file = options.record;
  cell.files = {"", ""};

  SessionOptions session;
  session.out = options.out;
  session.with_reader = false;
  session.by_rate = false;
  session.stop = options.stop;
  session.plan = plan_on_one_core(cell, options.core, options.bounds);
  session.write_map = false;
  return {run_session(cell, source, session), 0, {}};
}

BoardResult run_board(Cell cell, const FrameLoop& loop, const BoardOptions& options) {
  check_camera(cell, loop);
  // The first frame's exposure must not precede the start of the session's clock.
  const Duration period{loop.header().period_ns};
  LoopSource source(
      loop, {options.frames, period, period, k_arrival_priority, options.core, options.stop});
  BoardResult result = run_board(std::move(cell), source, options);
  result.frames_worst = source.worst_shown();
  result.frame_wake_up_ns = source.wake_ups_ns();
  if (!source.thread_report().refused.empty()) {
    result.refused.push_back(source.thread_report().name + ": " + source.thread_report().refused);
  }
  return result;
}

}  // namespace glint
