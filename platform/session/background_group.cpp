#include "platform/session/background_group.hpp"

#include <algorithm>
#include <utility>

#include "platform/input_error.hpp"
#include "platform/rt/clock.hpp"
#include "platform/session/choices.hpp"

namespace glint {
namespace {

// How long the end of a session may go unseen.
constexpr Duration k_look = milliseconds(20);

RunnerSettings<Background> background_settings(const Cell& cell, const GroupPlan<Background>& plan,
                                               TraceWriter* trace) {
  RunnerSettings<Background> settings;
  settings.plan = plan.tables;
  settings.group = k_background_group;
  settings.bounds_ns = plan.bounds_ns;
  settings.live = cell.realtime;
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

MapSettings map_settings_of(const Cell& cell) {
  MapSettings settings;
  settings.depth.stride = cell.mapping->stride;
  settings.voxels.voxel_m = static_cast<float>(cell.mapping->voxel_m);
  settings.voxels_max = cell.mapping->voxels_max;
  return in_slices(settings);
}

BackgroundGroup::BackgroundGroup(const Cell& cell, const GroupPlan<Background>& plan,
                                 TraceWriter* trace, DepthLoop pictures)
    : runner_(background_settings(cell, plan, trace)),
      period_(cell.background->period),
      pictures_(std::move(pictures)) {
  ExtendMap& map = graph_.node<ExtendMap>();
  map.limits = limits_of(cell);
  if (cell.mapping) {
    map.settings = map_settings_of(cell);
    map.pictures_a_map = cell.mapping->pictures_a_map;
    memory_.resize(MapSlices::bytes(map.settings));
    map.memory = memory_;
  }
  if (const graph::Prepared ready = graph_.prepare(); !ready) {
    throw InputError(cell.file +
                     ": mapping: " + std::string(name_of(static_cast<Reason>(ready.reason))) +
                     "; expected sizes that a map can have");
  }
}

ThreadSettings BackgroundGroup::thread_settings(const GroupPlan<Background>& plan) {
  ThreadSettings settings{"glint-slices", plan.cores[0], plan.priority};
  settings.idle_otherwise = true;
  return settings;
}

void BackgroundGroup::run(Time epoch, const std::atomic<bool>& stop) noexcept {
  for (std::int64_t number = 0; wait_until(epoch + period_ * number, stop);) {
    const Time nominal = Time{} + period_ * number;
    slice(nominal, Time{} + (monotonic_now() - epoch));
    const Duration ended = monotonic_now() - epoch;
    const Duration response = Time{} + ended - nominal;
    if (response > period_) ++counts_.late;
    counts_.longest_response = std::max(counts_.longest_response, response);
    const std::int64_t next = ended.nanoseconds / period_.nanoseconds + 1;
    counts_.skipped += static_cast<std::uint64_t>(next - number - 1);
    number = next;
  }
}

void BackgroundGroup::reach(Time now) noexcept {
  for (; Time{} + period_ * next_ <= now; ++next_) {
    const Time nominal = Time{} + period_ * next_;
    slice(nominal, nominal);
  }
}

void BackgroundGroup::slice(Time nominal, Time now) noexcept {
  if (std::as_const(graph_).output<MapProgress>().free) show(pictures_.newest(nominal));
  const std::uint64_t activation = ++counts_.slices;
  (void)runner_.run(graph_, {activation, static_cast<std::uint32_t>(activation), nominal, now, 0});
  runner_.settle(graph_);
  const MapProgress& progress = std::as_const(graph_).output<MapProgress>();
  counts_.longest_steps = std::max(counts_.longest_steps, progress.steps);
  counts_.map = progress.totals;
}

void BackgroundGroup::show(std::int64_t number) noexcept {
  if (number <= shown_) return;
  counts_.pictures_missed += number - shown_ - 1;
  shown_ = number;
  const DepthFrame& frame = pictures_.picture(number);
  (void)tracked_.sample();
  const auto end = std::copy_n(
      frame.left_out.begin(), std::min(frame.left_out.size(), left_out_.size()), left_out_.begin());
  const std::span<const LeftOut> held = tracked_.value().all();
  const auto room = static_cast<std::size_t>(left_out_.end() - end);
  const auto all = std::copy_n(held.begin(), std::min(held.size(), room), end);
  const auto count = static_cast<std::size_t>(all - left_out_.begin());
  graph_.input<ShownDepth>() = {{frame.picture(), pictures_.camera(), frame.T_world_camera,
                                 std::span(left_out_).first(count)},
                                pictures_.time_of(number),
                                static_cast<std::uint64_t>(number)};
}

void BackgroundGroup::finish() noexcept {
  ExtendMap& node = graph_.node<ExtendMap>();
  const auto run_on = [&] {
    while (!std::as_const(graph_).output<MapProgress>().free) graph_.activate();
  };
  run_on();
  node.make_map();
  graph_.activate();
  run_on();
  counts_.map = std::as_const(graph_).output<MapProgress>().totals;
}

}  // namespace glint
