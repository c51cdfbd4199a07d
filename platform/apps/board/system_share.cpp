#include "platform/apps/board/system_share.hpp"

#include <algorithm>

#include "platform/runtime/rt/clock.hpp"
#include "platform/runtime/rt/memory_lock.hpp"
#include "platform/runtime/rt/real_time_thread.hpp"
#include "platform/runtime/rt/release.hpp"
#include "platform/runtime/session/run_schedule.hpp"

namespace glint {
namespace {

// A clock reading that takes this many times the median was interrupted.
constexpr std::int64_t k_interrupted_factor = 4;
constexpr int k_undisturbed_readings = 1000;

constexpr Duration k_settle = milliseconds(20);

void sleeps(const SystemShareOptions& options, std::vector<std::int64_t>& late_ns) {
  const Time first = monotonic_now() + k_settle;
  for (int i = 0; i < options.wake_ups; ++i) {
    const Time due = first + options.tick_period * i;
    (void)sleep_until(due);
    late_ns.push_back((monotonic_now() - due).nanoseconds);
  }
}

void releases(const SystemShareOptions& options, std::vector<std::int64_t>& late_ns) {
  Release release;
  const Time first = monotonic_now() + k_settle;
  RealTimeThread waiting({"glint-frame", options.core, k_frame_priority}, [&] {
    for (int i = 0; i < options.wake_ups; ++i) {
      release.wait();
      late_ns.push_back((monotonic_now() - (first + options.tick_period * i)).nanoseconds);
    }
  });
  RealTimeThread releasing({"glint-arrival", options.core, k_arrival_priority}, [&] {
    for (int i = 0; i < options.wake_ups; ++i) {
      (void)sleep_until(first + options.tick_period * i);
      release.post();
    }
  });
  releasing.join();
  waiting.join();
}

std::int64_t median_reading_ns() {
  std::vector<std::int64_t> steps;
  for (int i = 0; i < k_undisturbed_readings; ++i) {
    const Time before = monotonic_now();
    steps.push_back((monotonic_now() - before).nanoseconds);
  }
  std::nth_element(steps.begin(), steps.begin() + k_undisturbed_readings / 2, steps.end());
  return std::max<std::int64_t>(1, steps[k_undisturbed_readings / 2]);
}

void interrupts(const SystemShareOptions& options, SystemShareFigures& figures) {
  figures.clock_read_ns = median_reading_ns();
  const Time end = monotonic_now() + options.interrupts_watched;
  Time last = monotonic_now(), last_interruption{};
  while (last < end) {
    const Time now = monotonic_now();
    const std::int64_t step_ns = (now - last).nanoseconds;
    if (step_ns > k_interrupted_factor * figures.clock_read_ns) {
      figures.interrupt_ns.push_back(step_ns - figures.clock_read_ns);
      if (last_interruption > Time{})
        figures.interrupt_gap_ns.push_back((now - last_interruption).nanoseconds);
      last_interruption = now;
    }
    last = now;
  }
}

void writes(CanSink& can, const SystemShareOptions& options, std::vector<std::int64_t>& took_ns) {
  const Time first = monotonic_now() + k_settle;
  CanFrame frame;
  frame.identifier = 0x1A0;
  frame.length = 8;
  for (int burst = 0; burst < options.can_bursts; ++burst) {
    (void)sleep_until(first + options.tick_period * burst);
    for (int i = 0; i < options.can_frames_a_burst; ++i) {
      frame.data[0] = static_cast<std::uint8_t>(i);
      const Time before = monotonic_now();
      if (can.send(frame, before)) took_ns.push_back((monotonic_now() - before).nanoseconds);
    }
  }
}

}  // namespace

SystemShareFigures measure_system_share(CanSink& can, const SystemShareOptions& options) {
  (void)lock_memory();
  SystemShareFigures figures;
  const auto wake_ups = static_cast<std::size_t>(options.wake_ups);
  figures.tick_wake_up_ns.reserve(wake_ups);
  figures.frame_wake_up_ns.reserve(wake_ups);
  figures.can_write_ns.reserve(
      static_cast<std::size_t>(options.can_bursts * options.can_frames_a_burst));
  // Capacity for one interrupt per microsecond; more are not stored.
  figures.interrupt_ns.reserve(
      static_cast<std::size_t>(options.interrupts_watched.nanoseconds / 1000));
  figures.interrupt_gap_ns.reserve(figures.interrupt_ns.capacity());
  RealTimeThread tick({"glint-tick", options.core, k_tick_priority}, [&] {
    sleeps(options, figures.tick_wake_up_ns);
    writes(can, options, figures.can_write_ns);
    interrupts(options, figures);
  });
  tick.join();
  releases(options, figures.frame_wake_up_ns);
  return figures;
}

}  // namespace glint
