#include "platform/session/session.hpp"

#include <atomic>
#include <memory>
#include <thread>
#include <utility>

#include "platform/rt/allocation_counter.hpp"
#include "platform/rt/clock.hpp"
#include "platform/rt/memory_lock.hpp"
#include "platform/rt/periodic_loop.hpp"
#include "platform/rt/real_time_thread.hpp"
#include "platform/session/frame_group.hpp"
#include "platform/session/pipeline.hpp"
#include "platform/session/scenario_of.hpp"
#include "platform/session/seed_method.hpp"
#include "platform/session/simulated_source.hpp"
#include "platform/session/sinks.hpp"
#include "platform/session/tick_group.hpp"
#include "platform/session/tracker_executor.hpp"

namespace glint {
namespace {

// Fixed priorities: on a core, tick preempts frame. Below the kernel's interrupt threads (50).
constexpr int k_tick_priority = 48;
constexpr int k_frame_priority = 45;

// From here to the first frame everything else starts.
constexpr Duration k_lead = milliseconds(300);

Duration tick_period(const Cell& cell) { return {static_cast<std::int64_t>(1e9 / cell.tick_hz)}; }

std::unique_ptr<FrameMethod> method_of(const Cell& cell) {
  if (cell.method == Method::seed) return std::make_unique<SeedMethod>(cell);
  return nullptr;  // the tracker
}

// What both kinds of run share: the groups, what they exchange, and where their output goes.
struct Groups {
  Groups(const Cell& cell, const sim::Simulator& simulator, Sinks& sinks, Clock now,
         std::int64_t unix_offset_ns)
      : executor(cell.workers, k_frame_priority),
        frame(
            cell, tool_set, now, [this](Tracker& tracker) { executor.activate(tracker); },
            sinks.recorder() != nullptr ? &sinks.recorder()->frame_lane() : nullptr,
            method_of(cell)),
        tick(cell, frame.estimates(), robot, now,
             {sinks.can(), sinks.dds(), sinks.files(),
              sinks.recorder() != nullptr ? &sinks.recorder()->tick_lane() : nullptr},
             unix_offset_ns, static_cast<std::size_t>(simulator.frame_count())) {
    tool_set.write_slot() = cell.tools;
    tool_set.publish(1, 0);
    robot.write_slot() = declared_robot_frame(cell);
    robot.publish(1, 0);
    outcomes.resize(static_cast<std::size_t>(simulator.frame_count()));
  }

  void process(const ArrivedFrame& arrived) noexcept {
    frame.process(arrived);
    if (processed < outcomes.size()) {
      outcomes[processed++] = outcome_of(frame.newest());
    }
  }

  TrackerExecutor executor;
  graph::TripleBuffer<ToolSet> tool_set;
  graph::TripleBuffer<RobotFrame> robot;
  FrameGroup frame;
  TickGroup tick;
  std::vector<FrameOutcome> outcomes;
  std::size_t processed = 0;
};

bool stopped(const SessionOptions& options) noexcept {
  return options.stop != nullptr && *options.stop;
}

void note(const ThreadReport& report, SessionResult& result) {
  if (!report.refused.empty()) result.refused.push_back(report.name + ": " + report.refused);
}

// Frames when they arrive, ticks by the clock, each in a thread of its own.
void run_live(const Cell& cell, Time epoch, SimulatedSource& source, Groups& groups, Time last,
              const SessionOptions& options, SessionResult& result) {
  std::atomic<bool> frames_done{false};
  std::atomic<std::int64_t> reached_ns{0};
  const std::uint64_t allocations_before = AllocationCounter::count();
  const Time end = last + cell.lost_after;
  const auto after_epoch = [epoch](Time monotonic) { return Time{} + (monotonic - epoch); };

  PeriodicLoop loop(epoch, tick_period(cell));
  RealTimeThread frame_thread({"glint-frame", -1, k_frame_priority}, [&] {
    AllocationCounter::arm();
    ArrivedFrame arrived;
    while (!stopped(options) && source.wait(arrived)) {
      groups.process(arrived);
      source.give_back(arrived);
    }
    AllocationCounter::disarm();
    frames_done = true;
  });
  RealTimeThread tick_thread({"glint-tick", -1, k_tick_priority}, [&] {
    AllocationCounter::arm();
    for (;;) {
      const Tick tick = loop.next();
      const Time nominal = after_epoch(tick.nominal);
      if (frames_done && (nominal > end || stopped(options))) break;
      groups.tick.tick(tick.number, nominal, after_epoch(tick.woken));
      ++result.ticks;
      reached_ns = nominal.nanoseconds;
    }
    AllocationCounter::disarm();
  });
  const double all_s = static_cast<double>(end.nanoseconds) * 1e-9;
  while (!frames_done ||
         (reached_ns < (end - tick_period(cell)).nanoseconds && !stopped(options))) {
    if (options.progress) options.progress(static_cast<double>(reached_ns) * 1e-9, all_s);
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  frame_thread.join();
  tick_thread.join();
  result.ticks_late = static_cast<std::int64_t>(loop.late());
  result.ticks_skipped = static_cast<std::int64_t>(loop.skipped());
  result.heap_allocations_after_start = AllocationCounter::count() - allocations_before;
  result.heap_counted = AllocationCounter::available();
  note(frame_thread.report(), result);
  note(tick_thread.report(), result);
  for (const ThreadReport& report : groups.executor.reports()) note(report, result);
}

// Frames and ticks in the order of their nominal times, in one thread: the same bytes every time.
void run_in_order(const Cell& cell, Time& now, SimulatedSource& source, Groups& groups,
                  double all_s, const SessionOptions& options, SessionResult& result) {
  const Duration period = tick_period(cell);
  Time next_tick;
  const auto tick_until = [&](Time limit) {
    for (; next_tick < limit; next_tick = next_tick + period) {
      now = next_tick;
      groups.tick.tick(static_cast<std::uint32_t>(result.ticks++), next_tick, next_tick);
    }
  };
  ArrivedFrame arrived;
  Time last;
  while (!stopped(options) && source.wait(arrived)) {
    tick_until(arrived.frame.arrival);
    now = last = arrived.frame.arrival;
    groups.process(arrived);
    source.give_back(arrived);
    if (options.progress) {
      options.progress(static_cast<double>(now.nanoseconds) * 1e-9, all_s);
    }
  }
  tick_until(last + cell.lost_after);
}

}  // namespace

SessionResult run_session(const Cell& cell, const SessionOptions& options) {
  return run_session(cell, scenario_of(cell), options);
}

SessionResult run_session(const Cell& cell, sim::Scenario scenario, const SessionOptions& options) {
  const sim::Simulator simulator(std::move(scenario));
  SessionResult result;
  if (cell.realtime) {
    if (const MemoryLock lock = lock_memory(); !lock.locked) {
      result.refused.push_back("memory: " + lock.refused);
    }
  }

  // The session's clock starts with the first frame's exposure. Sinks need its distance to Unix
  // time, so it is fixed before they are opened, far enough ahead that they are ready by then.
  Time simulated_now;
  const Duration lead = k_lead + (cell.dds.on && cell.realtime ? milliseconds(1200) : Duration{});
  const Time epoch = monotonic_now() + lead;
  const std::int64_t unix_offset_ns = unix_offset().nanoseconds + epoch.nanoseconds;
  Clock now = [&simulated_now] { return simulated_now; };
  SleepUntil sleep;
  if (cell.realtime) {
    now = [epoch] { return Time{} + (monotonic_now() - epoch); };
    sleep = [epoch](Time time) { sleep_until(epoch + (time - Time{})); };
  }

  Sinks sinks(cell, options, unix_offset_ns);
  auto groups = std::make_unique<Groups>(cell, simulator, sinks, now, unix_offset_ns);
  SimulatedSource source(simulator, sleep, now);
  source.fill();
  if (cell.realtime) {
    const Time last = simulator.timing(simulator.frame_count() - 1).arrival;
    run_live(cell, epoch, source, *groups, last, options, result);
  } else {
    run_in_order(cell, simulated_now, source, *groups, simulator.scenario().duration.seconds(),
                 options, result);
  }

  groups->outcomes.resize(groups->processed);
  result.frames = static_cast<std::int64_t>(groups->processed);
  result.duration_s = simulator.scenario().duration.seconds();
  result.accuracy = judge(groups->outcomes, source.truths(), cell.tools, cell.lost_after);
  result.latencies = groups->tick.latencies().entries();
  result.late_renders = source.late_renders();
  result.worker_overruns = groups->executor.overruns();
  result.can_frames = groups->tick.can_frames();
  result.output_sha256 = groups->tick.output_sha256();
  sinks.close(result);
  return result;
}

}  // namespace glint
