#include "platform/apps/board/board_run.hpp"

#include <utility>

#include "platform/apps/board/board_checks.hpp"
#include "platform/apps/board/loop_source.hpp"

namespace glint {

RunSchedule schedule_on_one_core(Cell cell, int core, const NodeWcets& bounds) {
  cell.workers = 1;
  RunSchedule plan = schedule_by_rule(cell);
  plan.planned = true;
  plan.frame.cores = plan.tick.cores = {core};
  plan.frame.remaining_ns = remaining_in_order(bounds.frame_ns);
  plan.tick.remaining_ns = remaining_in_order(bounds.tick_ns);
  if (plan.background) plan.background->cores = {core};
  return plan;
}

CompanionResult run_companion(Cell cell, FrameSource& source, const CompanionOptions& options) {
  check_for_companion(cell);
  cell.realtime = true;
  cell.record.file = options.record;
  cell.files = {"", ""};

  SessionOptions session;
  session.out = options.out;
  session.with_reader = false;
  session.by_rate = false;
  session.stop = options.stop;
  session.plan = schedule_on_one_core(cell, options.core, options.bounds);
  session.write_map = false;
  session.service = options.service;
  session.enabled = options.enabled;
  return {run_session(cell, source, session), 0, {}};
}

CompanionResult run_companion(Cell cell, const FrameLoop& loop, const CompanionOptions& options) {
  check_camera(cell, loop);
  // The first frame's exposure must not precede the start of the session's clock.
  const Duration period{loop.header().period_ns};
  LoopSource source(
      loop, {options.frames, period, period, k_arrival_priority, options.core, options.stop});
  CompanionResult result = run_companion(std::move(cell), source, options);
  result.frames_worst = source.worst_frames_delivered();
  result.frame_wake_up_ns = source.wake_ups_ns();
  if (!source.thread_report().refused.empty()) {
    result.refused.push_back(source.thread_report().name + ": " + source.thread_report().refused);
  }
  return result;
}

}  // namespace glint
