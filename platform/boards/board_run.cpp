#include "platform/boards/board_run.hpp"

#include <atomic>
#include <memory>
#include <optional>
#include <utility>

#include "platform/boards/board_checks.hpp"
#include "platform/boards/board_groups.hpp"
#include "platform/boards/loop_source.hpp"
#include "platform/rt/allocation_counter.hpp"
#include "platform/rt/clock.hpp"
#include "platform/rt/memory_lock.hpp"
#include "platform/rt/page_faults.hpp"
#include "platform/rt/periodic_loop.hpp"
#include "platform/rt/real_time_thread.hpp"
#include "platform/session/run_plan.hpp"

namespace glint {
namespace {

// From here to the first frame everything starts; its ticks are due before it. The memory of a map
// and of a recording is touched by then.
Duration lead_of(const Cell& cell) {
  const bool much = cell.background || !cell.record.file.empty();
  return milliseconds(much ? 1000 : 100);
}

// Runs `body` armed: from here on neither the heap nor a page that is not there may be touched.
template <class Body>
void counted(Body body) {
  prefault_stack();
  AllocationCounter::arm();
  PageFaultCounter::arm();
  body();
  PageFaultCounter::disarm();
  AllocationCounter::disarm();
}

}  // namespace

BoardResult run_board(Cell cell, const FrameLoop& loop, const BoardOptions& options) {
  check_for_board(cell, loop);
  BackgroundScene scene = read_background_scene(cell, nullptr);
  cell.realtime = true;
  cell.record.file = options.record;
  cell.files = {"", ""};

  BoardResult result;
  if (const MemoryLock lock = lock_memory(); !lock.locked) {
    result.refused.push_back("memory: " + lock.refused);
  }
  const Duration tick_period{static_cast<std::int64_t>(1e9 / cell.tick_hz)};
  const Duration frame_period{loop.header().period_ns};
  const Time epoch = monotonic_now() + lead_of(cell);
  const std::int64_t unix_offset_ns = unix_offset().nanoseconds + epoch.nanoseconds;
  Sinks sinks(cell, {options.out, false, result.refused}, unix_offset_ns);
  auto groups = std::make_unique<BoardGroups>(
      cell, sinks, [epoch] { return Time{} + (monotonic_now() - epoch); }, unix_offset_ns,
      options.frames > 0 ? static_cast<std::size_t>(options.frames) : LatencyLog::k_entries_max,
      options.bounds, std::move(scene));
  WakeUpLog tick_wake_ups(WakeUpLog::k_entries_max);
  // Ticks go on until the last frame's poses are lost, or until the run is stopped.
  const auto stopped = [&] { return options.stop != nullptr && *options.stop; };
  const Time last_tick = Time{} + frame_period * options.frames + cell.lost_after;
  std::atomic<bool> frames_done{false}, ran_away{false};

  // The first frame's exposure must not lie before the session's clock began.
  LoopSource source(loop, {options.frames, frame_period, epoch + frame_period, epoch,
                           k_arrival_priority, options.core, options.stop});
  PeriodicLoop ticks(epoch, tick_period);
  const std::uint64_t allocations_before = AllocationCounter::count();
  const std::uint64_t faults_before = PageFaultCounter::count();
  RealTimeThread tick_thread({"glint-tick", options.core, k_tick_priority}, [&] {
    counted([&] {
      for (;;) {
        const std::optional<Tick> tick = ticks.next();
        if (!tick) {
          groups->stop_safe();
          ran_away = true;
          break;
        }
        const Time nominal = Time{} + (tick->nominal - epoch);
        if (options.frames > 0 && nominal > last_tick) break;
        if (frames_done && stopped()) break;
        groups->tick(tick->number, nominal, Time{} + (tick->woken - epoch));
        tick_wake_ups.add((tick->woken - tick->nominal).nanoseconds);
        ++result.ticks;
      }
    });
  });
  RealTimeThread frame_thread({"glint-frame", options.core, k_frame_priority}, [&] {
    counted([&] {
      ArrivedFrame arrived;
      while (!ran_away && source.wait(arrived)) {
        groups->process(arrived);
        source.give_back(arrived);
      }
    });
    frames_done = true;
  });
  std::atomic<bool> ended{false};
  std::optional<RealTimeThread> background_thread;
  if (BackgroundGroup* const background = groups->background()) {
    GroupPlan<Background> plan = *plan_by_rule(cell).background;
    plan.cores = {options.core};
    background_thread.emplace(BackgroundGroup::thread_settings(plan), [background, epoch, &ended] {
      counted([&] { background->run(epoch, ended); });
    });
  }
  source.start();
  frame_thread.join();
  tick_thread.join();
  ended = true;
  if (background_thread) background_thread->join();

  result.heap_allocations = AllocationCounter::count() - allocations_before;
  result.heap_counted = AllocationCounter::available();
  result.page_faults = PageFaultCounter::count() - faults_before;
  std::vector<ThreadReport> reports{source.report(), frame_thread.report(), tick_thread.report()};
  if (background_thread) reports.push_back(background_thread->report());
  for (const ThreadReport& report : reports) {
    if (!report.refused.empty()) result.refused.push_back(report.name + ": " + report.refused);
  }
  result.frames_worst = source.worst_shown();
  result.frame_wake_up_ns = source.wake_ups_ns();
  result.tick_wake_up_ns = tick_wake_ups.entries();
  if (ran_away) result.sinks.fault = k_ran_away;
  result.ticks_late = static_cast<std::int64_t>(ticks.late());
  result.ticks_skipped = static_cast<std::int64_t>(ticks.skipped());
  groups->report(result);
  result.sinks.output_sha256 = result.output_sha256;
  sinks.close(result.sinks);
  return result;
}

}  // namespace glint
