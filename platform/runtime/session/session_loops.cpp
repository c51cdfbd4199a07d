#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <optional>
#include <thread>

#include "platform/runtime/rt/allocation_counter.hpp"
#include "platform/runtime/rt/clock.hpp"
#include "platform/runtime/rt/page_faults.hpp"
#include "platform/runtime/rt/periodic_loop.hpp"
#include "platform/runtime/rt/real_time_thread.hpp"
#include "platform/runtime/rt/service_notifier.hpp"
#include "platform/runtime/session/estimate_loop.hpp"
#include "platform/runtime/session/release_order.hpp"
#include "platform/runtime/session/session_groups.hpp"
#include "platform/sinks/dds/topic_names.hpp"

namespace glint {
namespace {

bool stopped(const SessionOptions& options) noexcept {
  return options.stop != nullptr && *options.stop;
}

void note(const ThreadReport& report, SessionResult& result) {
  if (!report.refused.empty()) result.refused.push_back(report.name + ": " + report.refused);
}

// Runs `body` with counters of heap allocations and page faults armed.
template <class Body>
void counted(Body body) {
  prefault_stack();
  AllocationCounter::arm();
  PageFaultCounter::arm();
  body();
  PageFaultCounter::disarm();
  AllocationCounter::disarm();
}

// Lines about the robot that were printed; each is printed once.
struct PrintedRobotWarnings {
  bool jumped = false, lacking = false, unusable = false, lost = false;
};

// Prints one line each at: the first rejected jump, the first joint state without one of the
// model's joints, the first that cannot be posed, and the first image without joints. Do not call
// on a real-time thread.
void print_robot_warnings(const SessionGroups& groups, PrintedRobotWarnings& printed) {
  const BackgroundGroup* const background = groups.background();
  if (background == nullptr) return;
  if (!printed.jumped && background->jumps() > 0) {
    printed.jumped = true;
    std::fprintf(
        stderr,
        "robot detected farther away than drift explains: rejected, the last pose stays in use\n");
  }
  if (const std::string* const joint = background->missing_joint(); joint && !printed.lacking) {
    printed.lacking = true;
    std::fprintf(
        stderr,
        "%s: a state without a position of joint '%s': ignored, the last joints stay in use\n",
        k_joint_states_topic, joint->c_str());
  }
  if (const Reason reason = background->unusable_joints();
      reason != Reason::none && !printed.unusable) {
    printed.unusable = true;
    std::fprintf(stderr,
                 "%s: an invalid state: %s; expected positions of at most %.0e rad or m: ignored\n",
                 k_joint_states_topic, std::string(name_of(reason)).c_str(), k_joint_position_max);
  }
  if (!printed.lost && background->without_joints() > 0) {
    printed.lost = true;
    std::fprintf(stderr,
                 "%s: no state for longer than mapping.joints_lost_after_ms: the robot is not "
                 "tracked until the next one\n",
                 k_joint_states_topic);
  }
}

// Prints one line at the first fault of each kind. Do not call on a real-time thread.
void print_source_faults(const SourceFaults* faults, std::array<bool, k_source_faults>& printed) {
  for (std::size_t kind = 0; faults != nullptr && kind < k_source_faults; ++kind) {
    const auto fault = static_cast<SourceFault>(kind);
    if (printed[kind] || faults->of(fault) == 0) continue;
    printed[kind] = true;
    std::fprintf(stderr, "source: %s; further ones are counted\n",
                 std::string(name_of(fault)).c_str());
  }
}

}  // namespace

void run_live(const Cell& cell, Time epoch, FrameSource& source, SessionGroups& groups,
              const SessionOptions& options, SessionResult& result) {
  std::atomic<bool> frames_done{false}, ran_away{false};
  std::atomic<std::int64_t> reached_ns{0}, end_ns{0};  // last tick; end once frames_done
  std::atomic<std::uint64_t> ticks{0};
  const auto ends = [&] { return stopped(options) || ran_away; };
  const std::uint64_t allocations_before = AllocationCounter::count();
  const std::uint64_t faults_before = PageFaultCounter::count();
  const auto after_epoch = [epoch](Time monotonic) { return Time{} + (monotonic - epoch); };

  ServiceNotifier* const service = options.service;
  if (service != nullptr) {
    service->watch(source.advances());
    service->watch(ticks);
  }
  if (options.enabled) groups.enable(options.enabled());
  PeriodicLoop by_clock(epoch, tick_period_of(cell));
  EstimateLoop by_estimates(cell, epoch, groups.measured());  // tick_release = "estimate"
  const bool is_by_clock = cell.tick_release == TickRelease::clock;
  WakeUpLog wake_ups(WakeUpLog::k_entries_max);
  const RunSchedule& plan = options.plan;
  RealTimeThread frame_thread({"glint-frame", plan.frame.cores[0], plan.frame.priority}, [&] {
    counted([&] {
      ArrivedFrame arrived;
      while (!ends() && source.wait(arrived)) {
        groups.process(arrived);
        source.release_pixels(arrived);
        source.note_advance();
      }
      end_ns = (arrived.frame.arrival + cell.lost_after).nanoseconds;
    });
    frames_done = true;
  });
  RealTimeThread tick_thread({"glint-tick", plan.tick.cores[0], plan.tick.priority}, [&] {
    counted([&] {
      for (;;) {
        const std::optional<Tick> tick = is_by_clock ? by_clock.next() : by_estimates.next();
        if (!tick) {
          groups.stop_safe();
          ran_away = true;
          break;
        }
        const Time nominal = after_epoch(tick->nominal);
        if (frames_done && (nominal.nanoseconds > end_ns || stopped(options))) break;
        groups.tick(tick->number, nominal, after_epoch(tick->woken));
        wake_ups.add((tick->woken - tick->nominal).nanoseconds);
        ++ticks;
        reached_ns = nominal.nanoseconds;
      }
    });
  });
  std::atomic<bool> ended{false};
  std::optional<RealTimeThread> background_thread;
  if (BackgroundGroup* const background = groups.background()) {
    background_thread.emplace(
        BackgroundGroup::thread_settings(*plan.background),
        [background, epoch, &ended] { counted([&] { background->run(epoch, ended); }); });
  }
  const double all_s = (source.duration() + cell.lost_after).seconds();
  PrintedRobotWarnings printed;
  std::array<bool, k_source_faults> printed_faults{};
  while (!frames_done || (reached_ns + tick_period_of(cell).nanoseconds < end_ns && !ends())) {
    // The source may be late; the ticks are not.
    const double reached_s = static_cast<double>(reached_ns) * 1e-9;
    if (options.progress) {
      options.progress(std::min(reached_s, source.delivered_part() * all_s), all_s);
    }
    groups.apply_changes(Time{reached_ns});
    if (options.enabled) groups.enable(options.enabled());
    if (service != nullptr && ticks > 0) {
      service->ready();
      service->feed(monotonic_now());
    }
    print_robot_warnings(groups, printed);
    print_source_faults(source.faults(), printed_faults);
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  if (service != nullptr) service->stopping();
  frame_thread.join();
  tick_thread.join();
  result.ticks = static_cast<std::int64_t>(ticks);
  ended = true;
  if (background_thread) background_thread->join();
  if (ran_away) result.fault = k_no_sleep_message;
  result.ticks_late = static_cast<std::int64_t>(by_clock.late());
  result.ticks_skipped = static_cast<std::int64_t>(by_clock.skipped() + by_estimates.skipped());
  result.tick_wake_up_ns = wake_ups.entries();
  result.heap_allocations_after_start = AllocationCounter::count() - allocations_before;
  result.heap_counted = AllocationCounter::available();
  result.page_faults_after_start = PageFaultCounter::count() - faults_before;
  result.duration_s = static_cast<double>(reached_ns) * 1e-9;
  note(frame_thread.report(), result);
  note(tick_thread.report(), result);
  if (background_thread) note(background_thread->report(), result);
}

void run_in_order(const Cell& cell, Time& now, FrameSource& source, SessionGroups& groups,
                  const SessionOptions& options, SessionResult& result) {
  NominalOrder order(cell, source, groups.measured(), options.stop);
  PrintedRobotWarnings printed;
  const auto on_tick = [&](const NextRelease& release) {
    now = release.nominal;
    result.duration_s = (now - Time{}).seconds();
    ++result.ticks;
    if (groups.background() != nullptr) groups.background()->run_due_slices(now);
    groups.tick(release.tick, now, now);
  };
  const auto on_frame = [&](const NextRelease& release) {
    now = release.nominal;
    groups.apply_changes(now);
    groups.process(*release.frame);
    print_robot_warnings(groups, printed);
    if (options.progress) options.progress((now - Time{}).seconds(), source.duration().seconds());
  };
  run_releases(order, on_frame, on_tick);
}

}  // namespace glint
