#include "platform/session/session.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <thread>
#include <utility>

#include "platform/dds/topic_names.hpp"
#include "platform/input_error.hpp"
#include "platform/mapping/cloud_files.hpp"
#include "platform/mapping/depth_png.hpp"
#include "platform/programming/key_reader.hpp"
#include "platform/record/button_event.hpp"
#include "platform/rt/allocation_counter.hpp"
#include "platform/rt/clock.hpp"
#include "platform/rt/machine_check.hpp"
#include "platform/rt/memory_lock.hpp"
#include "platform/rt/page_faults.hpp"
#include "platform/rt/periodic_loop.hpp"
#include "platform/rt/real_time_thread.hpp"
#include "platform/session/scenario_of.hpp"
#include "platform/session/session_groups.hpp"
#include "platform/session/simulated_source.hpp"

namespace glint {
namespace {

// From here to the first frame everything else starts.
constexpr Duration k_lead = milliseconds(300);

Duration tick_period(const Cell& cell) { return {static_cast<std::int64_t>(1e9 / cell.tick_hz)}; }

bool stopped(const SessionOptions& options) noexcept {
  return options.stop != nullptr && *options.stop;
}

std::vector<int> cores_of(const RunPlan& plan) {
  std::vector<int> cores = plan.frame.cores;
  cores.insert(cores.end(), plan.tick.cores.begin(), plan.tick.cores.end());
  if (plan.background) cores.push_back(plan.background->cores[0]);
  return cores;
}

void note(const ThreadReport& report, SessionResult& result) {
  if (!report.refused.empty()) result.refused.push_back(report.name + ": " + report.refused);
}

// Runs `body` declared free of heap allocations and page faults.
template <class Body>
void counted(Body body) {
  prefault_stack();
  AllocationCounter::arm();
  PageFaultCounter::arm();
  body();
  PageFaultCounter::disarm();
  AllocationCounter::disarm();
}

// What was said of the robot, once each.
struct ToldOfRobot {
  bool jumped = false, lacking = false, unusable = false, lost = false;
};

// A line when the robot is first seen to have jumped, when its joints are first heard without one
// that its model has, or as they cannot be, and when they are first no longer heard; not by a
// real-time thread.
void tell_of_robot(const SessionGroups& groups, ToldOfRobot& told) {
  const BackgroundGroup* const background = groups.background();
  if (background == nullptr) return;
  if (!told.jumped && background->jumps() > 0) {
    told.jumped = true;
    std::fprintf(stderr,
                 "the robot is seen where no drift takes it: refused; the run goes on from where "
                 "it was\n");
  }
  if (const std::string* const joint = background->lacking_joint(); joint && !told.lacking) {
    told.lacking = true;
    std::fprintf(stderr,
                 "%s: a state without a position of joint '%s': its model stays where it was\n",
                 k_joint_states_topic, joint->c_str());
  }
  if (const Reason reason = background->unusable_joints();
      reason != Reason::none && !told.unusable) {
    told.unusable = true;
    std::fprintf(stderr,
                 "%s: a state that cannot pose the robot: %s; expected positions of at most %.0e "
                 "rad or m: its model stays where it was\n",
                 k_joint_states_topic, std::string(name_of(reason)).c_str(), k_joint_position_max);
  }
  if (!told.lost && background->without_joints() > 0) {
    told.lost = true;
    std::fprintf(stderr,
                 "%s: nothing for longer than mapping.joints_lost_after_ms: the robot is not "
                 "followed until it is heard again\n",
                 k_joint_states_topic);
  }
}

// Frames when they arrive, ticks and slices by the clock, each group in a thread of its own.
void run_live(const Cell& cell, Time epoch, SimulatedSource& source, SessionGroups& groups,
              Time last, const SessionOptions& options, SessionResult& result) {
  std::atomic<bool> frames_done{false}, ran_away{false};
  std::atomic<std::int64_t> reached_ns{0};
  const auto ends = [&] { return stopped(options) || ran_away; };
  const std::uint64_t allocations_before = AllocationCounter::count();
  const std::uint64_t faults_before = PageFaultCounter::count();
  const Time end = last + cell.lost_after;
  const auto after_epoch = [epoch](Time monotonic) { return Time{} + (monotonic - epoch); };

  PeriodicLoop loop(epoch, tick_period(cell));
  const RunPlan& plan = options.plan;
  RealTimeThread frame_thread({"glint-frame", plan.frame.cores[0], plan.frame.priority}, [&] {
    counted([&] {
      ArrivedFrame arrived;
      while (!ends() && source.wait(arrived)) {
        groups.process(arrived);
        source.give_back(arrived);
      }
    });
    frames_done = true;
  });
  RealTimeThread tick_thread({"glint-tick", plan.tick.cores[0], plan.tick.priority}, [&] {
    counted([&] {
      for (;;) {
        const std::optional<Tick> tick = loop.next();
        if (!tick) {
          groups.stop_safe();
          ran_away = true;
          break;
        }
        const Time nominal = after_epoch(tick->nominal);
        if (frames_done && (nominal > end || stopped(options))) break;
        groups.tick(tick->number, nominal, after_epoch(tick->woken));
        ++result.ticks;
        reached_ns = nominal.nanoseconds;
      }
    });
  });
  std::atomic<bool> ended{false};
  std::optional<RealTimeThread> background_thread;
  if (BackgroundGroup* const background = groups.background()) {
    background_thread.emplace(BackgroundGroup::thread_settings(*plan.background),
                              [background, epoch, &ended] { background->run(epoch, ended); });
  }
  const double all_s = static_cast<double>(end.nanoseconds) * 1e-9;
  ToldOfRobot told;
  while (!frames_done || (reached_ns < (end - tick_period(cell)).nanoseconds && !ends())) {
    // The source may be behind its time, the ticks are not.
    const double reached_s = static_cast<double>(reached_ns) * 1e-9;
    if (options.progress) {
      options.progress(std::min(reached_s, source.delivered_part() * all_s), all_s);
    }
    groups.reach(Time{reached_ns});
    tell_of_robot(groups, told);
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  frame_thread.join();
  tick_thread.join();
  ended = true;
  if (background_thread) background_thread->join();
  if (ran_away) result.fault = k_ran_away;
  result.ticks_late = static_cast<std::int64_t>(loop.late());
  result.ticks_skipped = static_cast<std::int64_t>(loop.skipped());
  result.heap_allocations_after_start = AllocationCounter::count() - allocations_before;
  result.heap_counted = AllocationCounter::available();
  result.page_faults_after_start = PageFaultCounter::count() - faults_before;
  result.duration_s = static_cast<double>(reached_ns) * 1e-9;
  note(frame_thread.report(), result);
  note(tick_thread.report(), result);
  if (background_thread) note(background_thread->report(), result);
}

// Frames, ticks and slices in the order of their nominal times, in one thread: the same bytes every
// time.
void run_in_order(const Cell& cell, Time& now, SimulatedSource& source, SessionGroups& groups,
                  double all_s, const SessionOptions& options, SessionResult& result) {
  const Duration period = tick_period(cell);
  Time next_tick;
  const auto tick_until = [&](Time limit) {
    for (; next_tick < limit; next_tick = next_tick + period) {
      now = next_tick;
      result.duration_s = (now - Time{}).seconds();
      if (groups.background() != nullptr) groups.background()->reach(now);
      groups.tick(static_cast<std::uint64_t>(result.ticks++), next_tick, next_tick);
    }
  };
  ArrivedFrame arrived;
  Time last;
  ToldOfRobot told;
  while (!stopped(options) && source.wait(arrived)) {
    tick_until(arrived.frame.arrival);
    now = last = arrived.frame.arrival;
    groups.reach(now);
    groups.process(arrived);
    source.give_back(arrived);
    tell_of_robot(groups, told);
    if (options.progress) {
      options.progress(static_cast<double>(now.nanoseconds) * 1e-9, all_s);
    }
  }
  tick_until(last + cell.lost_after);
}

// The last map, when nothing runs any more.
void write_map(BackgroundGroup& background, const std::string& folder, SessionResult& result) {
  background.finish();
  if (background.map().count == 0) return;
  const std::string file = (std::filesystem::path(folder) / "map.ply").string();
  try {
    write_cloud(file, host_cloud_of(background.map()));
    result.files.push_back(file);
  } catch (const InputError& error) {  // a full disk costs the map, not the figures
    result.not_written.push_back(error.what());
  }
}

}  // namespace

SessionResult run_session(const Cell& cell, const SessionOptions& options) {
  return run_session(cell, scenario_of(cell), options);
}

SessionResult run_session(const Cell& cell, sim::Scenario scenario, const SessionOptions& given) {
  const sim::Simulator simulator(std::move(scenario));
  BackgroundScene scene = read_background_scene(cell, read_depth_png);
  SessionOptions options = given;
  if (!options.plan.planned) options.plan = plan_by_rule(cell);
  SessionResult result;
  // What can be rendered before the session's clock starts cannot be late.
  SimulatedSource source(simulator, {cell.realtime, options.source_frame_time});
  source.fill([&options](int rendered, int wanted) {
    if (options.rendering) options.rendering(rendered, wanted);
    return !stopped(options);
  });
  if (cell.realtime) {
    if (const MemoryLock lock = lock_memory(); !lock.locked) {
      result.refused.push_back("memory: " + lock.refused);
    }
    result.machine = check_machine(cores_of(options.plan));
    options.best_effort = result.machine.spoils;
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
    // A refusal to sleep stops the tick loop, and with it the run.
    sleep = [epoch](Time time) { (void)sleep_until(epoch + (time - Time{})); };
  }

  Sinks sinks(cell, options, unix_offset_ns);
  std::optional<KeyReader> keys;
  if (options.keys) {
    keys.emplace(*options.keys, now, [&sinks, &result](const ButtonEvent& event) {
      ++result.key_events;
      sinks.offer_button(event);
    });
  }
  std::unique_ptr<TraceWriter> trace;
  if (options.trace) {
    const std::string file = (std::filesystem::path(options.out) / "trace.spans").string();
    trace = std::make_unique<TraceWriter>(file, trace_header(cell, options.plan, unix_offset_ns));
    result.files.push_back(file);
  }
  auto groups = std::make_unique<SessionGroups>(
      cell, options, static_cast<std::size_t>(simulator.frame_count()), sinks, trace.get(), now,
      unix_offset_ns, std::move(scene));
  if (trace != nullptr) trace->start();
  groups->watch(source);
  source.start(sleep, now);
  if (cell.realtime) {
    const Time last = simulator.timing(simulator.frame_count() - 1).arrival;
    run_live(cell, epoch, source, *groups, last, options, result);
  } else {
    run_in_order(cell, simulated_now, source, *groups, simulator.scenario().duration.seconds(),
                 options, result);
  }

  if (groups->background() != nullptr) write_map(*groups->background(), options.out, result);
  groups->report(result);
  result.accuracy = judge(result.outcomes, source.truths(), cell.tools);
  result.late_renders = source.late_renders();
  if (trace != nullptr) {
    if (const std::string wrong = trace->close(); !wrong.empty()) {
      result.not_written.push_back(wrong);
    }
    result.trace_spans = trace->written();
    result.trace_dropped = trace->dropped();
  }
  keys.reset();
  sinks.close(result);
  return result;
}

}  // namespace glint
