#include "platform/boards/board_run.hpp"

#include <memory>
#include <utility>

#include "platform/boards/board_groups.hpp"
#include "platform/boards/loop_source.hpp"
#include "platform/input_error.hpp"
#include "platform/rt/allocation_counter.hpp"
#include "platform/rt/clock.hpp"
#include "platform/rt/memory_lock.hpp"
#include "platform/rt/page_faults.hpp"
#include "platform/rt/periodic_loop.hpp"
#include "platform/rt/real_time_thread.hpp"
#include "platform/session/run_plan.hpp"

namespace glint {
namespace {

// From here to the first frame everything starts; its ticks are due before it.
constexpr Duration k_lead = milliseconds(100);

void require_same_camera(const Cell& cell, const FrameLoop& loop) {
  const FrameLoopHeader& header = loop.header();
  const CameraModel& model = cell.camera.model;
  const auto text = [](auto width, auto height, auto bits) {
    return std::to_string(width) + " x " + std::to_string(height) + " pixels of " +
           std::to_string(bits) + " bits";
  };
  const std::string found = text(header.width, header.height, header.reflectivity_bits);
  const std::string expected = text(model.width, model.height, cell.camera.reflectivity_bits);
  if (found != expected) {
    throw InputError("the loop has frames of " + found + "; expected " + expected +
                     ", as the cell's camera has");
  }
}

// Otherwise it would run less than what was planned.
void require_no_background(const Cell& cell) {
  if (!cell.background) return;
  throw InputError(cell.file +
                   ": has a [background]; expected none, for a board runs the frame "
                   "and tick groups only");
}

void require_no_tool_changes(const Cell& cell) {
  if (cell.tool_changes.empty()) return;
  throw InputError(cell.file +
                   ": has a [[tool_change]]; expected none, for a board keeps the tools that it "
                   "starts with (absent = [..] leaves some out)");
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
  require_same_camera(cell, loop);
  require_no_background(cell);
  require_no_tool_changes(cell);
  cell.realtime = true;
  cell.record.file.clear();
  cell.files = {"", ""};

  BoardResult result;
  if (const MemoryLock lock = lock_memory(); !lock.locked) {
    result.refused.push_back("memory: " + lock.refused);
  }
  const Duration tick_period{static_cast<std::int64_t>(1e9 / cell.tick_hz)};
  const Duration frame_period{loop.header().period_ns};
  const Time epoch = monotonic_now() + k_lead;
  const std::int64_t unix_offset_ns = unix_offset().nanoseconds + epoch.nanoseconds;
  Sinks sinks(cell, {options.out, false, result.refused}, unix_offset_ns);
  auto groups = std::make_unique<BoardGroups>(
      cell, sinks, [epoch] { return Time{} + (monotonic_now() - epoch); }, unix_offset_ns,
      static_cast<std::size_t>(options.frames), options.bounds);
  const Duration run = frame_period * options.frames + cell.lost_after;
  result.tick_wake_up_ns.reserve(
      static_cast<std::size_t>(run.nanoseconds / tick_period.nanoseconds + 1));

  // The first frame's exposure must not lie before the session's clock began.
  LoopSource source(loop, {options.frames, frame_period, epoch + frame_period, epoch,
                           k_arrival_priority, options.core});
  PeriodicLoop ticks(epoch, tick_period);
  const std::uint64_t allocations_before = AllocationCounter::count();
  const std::uint64_t faults_before = PageFaultCounter::count();
  RealTimeThread tick_thread({"glint-tick", options.core, k_tick_priority}, [&] {
    counted([&] {
      while (result.tick_wake_up_ns.size() < result.tick_wake_up_ns.capacity()) {
        const Tick tick = ticks.next();
        const Time nominal = Time{} + (tick.nominal - epoch);
        if (nominal > Time{} + run) break;
        groups->tick(tick.number, nominal, Time{} + (tick.woken - epoch));
        result.tick_wake_up_ns.push_back((tick.woken - tick.nominal).nanoseconds);
      }
    });
  });
  RealTimeThread frame_thread({"glint-frame", options.core, k_frame_priority}, [&] {
    counted([&] {
      ArrivedFrame arrived;
      while (source.wait(arrived)) {
        groups->process(arrived);
        source.give_back(arrived);
      }
    });
  });
  source.start();
  frame_thread.join();
  tick_thread.join();

  result.heap_allocations = AllocationCounter::count() - allocations_before;
  result.heap_counted = AllocationCounter::available();
  result.page_faults = PageFaultCounter::count() - faults_before;
  for (const ThreadReport* report :
       {&source.report(), &frame_thread.report(), &tick_thread.report()}) {
    if (!report->refused.empty()) result.refused.push_back(report->name + ": " + report->refused);
  }
  result.frames_worst = source.worst_shown();
  result.frame_wake_up_ns = source.wake_ups_ns();
  result.ticks = static_cast<std::int64_t>(result.tick_wake_up_ns.size());
  result.ticks_late = static_cast<std::int64_t>(ticks.late());
  result.ticks_skipped = static_cast<std::int64_t>(ticks.skipped());
  groups->report(result);
  result.sinks.output_sha256 = result.output_sha256;
  sinks.close(result.sinks);
  return result;
}

}  // namespace glint
