#include "platform/session/background_group.hpp"

#include <algorithm>
#include <utility>

#include "platform/rt/clock.hpp"
#include "platform/session/choices.hpp"

namespace glint {
namespace {

// How long the end of a session may go unseen.
constexpr Duration k_look = milliseconds(20);

RunnerSettings<Background> runner_settings(const GroupPlan<Background>& plan, TraceWriter* trace) {
  RunnerSettings<Background> settings;
  settings.plan = plan.tables;
  settings.group = k_background_group;
  settings.bounds_ns = plan.bounds_ns;
  settings.trace = trace;
  return settings;
}

// Whether the time has come; otherwise the session ended first.
bool wait_until(Time due, const std::atomic<bool>& stop) noexcept {
  while (!stop) {
    const Time now = monotonic_now();
    if (now >= due) return true;
    sleep_until(std::min(due, now + k_look));
  }
  return false;
}

}  // namespace

BackgroundGroup::BackgroundGroup(const Cell& cell, const GroupPlan<Background>& plan,
                                 TraceWriter* trace)
    : runner_(runner_settings(plan, trace)), period_(cell.background->period) {
  graph_.node<BackgroundSlice>().limits = limits_of(cell);
  graph_.node<BackgroundSlice>().steps = cell.background->steps;
}

ThreadSettings BackgroundGroup::thread_settings(const GroupPlan<Background>& plan) {
  ThreadSettings settings{"glint-slices", plan.cores[0], plan.priority};
  settings.idle_otherwise = true;
  return settings;
}

void BackgroundGroup::run(Time epoch, const std::atomic<bool>& stop) noexcept {
  for (std::int64_t number = 0; wait_until(epoch + period_ * number, stop);) {
    const Time nominal = Time{} + period_ * number;
    graph_.input<BackgroundSeed>().value = std::as_const(graph_).output<BackgroundDigest>().value;
    (void)runner_.run(graph_,
                      {static_cast<std::uint64_t>(number) + 1, static_cast<std::uint32_t>(number),
                       nominal, Time{} + (monotonic_now() - epoch), 0});
    runner_.settle(graph_);
    const Duration ended = monotonic_now() - epoch;
    const Duration response = Time{} + ended - nominal;
    ++counts_.slices;
    if (response > period_) ++counts_.late;
    counts_.longest_response = std::max(counts_.longest_response, response);
    const std::int64_t next = ended.nanoseconds / period_.nanoseconds + 1;
    counts_.skipped += static_cast<std::uint64_t>(next - number - 1);
    number = next;
  }
}

}  // namespace glint
