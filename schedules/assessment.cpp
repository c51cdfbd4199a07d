#include "schedules/assessment.hpp"

#include <algorithm>
#include <cstdio>

namespace glint {
namespace {

constexpr std::size_t k_frame = 0, k_tick = 1;

std::string in_us(std::int64_t ns) {
  char text[40];
  std::snprintf(text, sizeof text, "%.1f us", static_cast<double>(ns) * 1e-3);
  return text;
}

// Adds a line if a bound is missing or exceeds its deadline.
void check_deadline(std::vector<std::string>& missed_deadlines, const std::string& name,
                    const std::optional<std::int64_t>& found, std::int64_t deadline) {
  if (found && *found <= deadline) return;
  missed_deadlines.push_back(name + ": bound " + (found ? in_us(*found) : "none") + ", deadline " +
                             in_us(deadline));
}

SharedResponse shared(const TaskModel& model, const TaskGroup& group, const GroupResponse& with,
                      const GroupResponse& without) {
  SharedResponse response;
  response.blocking_ns = without.blocking_ns;
  response.bound_ns = *without.response_ns - without.jitter_ns - response.blocking_ns;
  response.wake_up_ns = model.system.wake_up_ns * (with.times.cores_used > 1 ? 2 : 1);
  response.writes_ns = model.system.can_write_ns * group.can_writes;
  response.system_ns = *with.response_ns - with.jitter_ns - response.bound_ns -
                       response.blocking_ns - response.wake_up_ns - response.writes_ns;
  return response;
}

bool bounded(const std::vector<GroupResponse>& groups) {
  return std::all_of(groups.begin(), groups.end(),
                     [](const GroupResponse& group) { return group.response_ns.has_value(); });
}

// Adds the slowest own pose frame: worst-case time from queueing to last bit, and its minimum.
void add_bus(const AnalysisInput& input, const Assessment& found, std::int64_t jitter_ns,
             ChainParts& parts) {
  for (std::size_t f = 0; f < input.frames.size(); ++f) {
    const CanMessage& frame = input.frames[f];
    const bool carries_a_pose =
        frame.node == k_own_can_node && frame.period_ns == parts.tick_gap_ns;
    if (!carries_a_pose || !found.can[f].response_ns) continue;
    const std::int64_t from_queueing = *found.can[f].response_ns - jitter_ns;
    if (parts.bus_ns && from_queueing <= *parts.bus_ns) continue;
    parts.bus_ns = from_queueing;
    // At most every fifth bit is a stuff bit.
    parts.bus_min_ns = found.can[f].frame_ns * 4 / 5;
  }
}

}  // namespace

Assessment assess(const AnalysisInput& input) {
  Assessment found;
  const TaskModel& model = input.model;
  found.groups = group_responses(model, input.plan);
  for (const GroupResponse& group : found.groups) {
    check_deadline(found.missed_deadlines, "group " + group.name, group.response_ns,
                   group.deadline_ns);
  }
  found.can.resize(input.frames.size());
  if (!bounded(found.groups)) return found;

  TaskModel alone = model;
  alone.system = {};
  const std::vector<GroupResponse> without = group_responses(alone, input.plan);

  // What a tick sends may be queued at any time until the tick is done.
  const std::int64_t jitter_ns = *found.groups[k_tick].response_ns;
  std::vector<CanMessage> frames = input.frames;
  for (CanMessage& frame : frames) {
    if (frame.node == k_own_can_node) frame.jitter_ns += jitter_ns;
  }
  found.can = can_responses(frames, input.rates);
  for (std::size_t f = 0; f < frames.size(); ++f) {
    check_deadline(found.missed_deadlines, "CAN frame " + frames[f].name, found.can[f].response_ns,
                   frames[f].deadline_ns);
  }

  ChainParts parts;
  parts.sensor = input.sensor;
  parts.arrival_jitter_ns = model.groups[k_frame].jitter_ns;
  parts.frame_gap_ns = model.groups[k_frame].min_gap_ns;
  parts.tick_gap_ns = model.groups[k_tick].min_gap_ns;
  parts.frame = shared(model, model.groups[k_frame], found.groups[k_frame], without[k_frame]);
  parts.tick = shared(model, model.groups[k_tick], found.groups[k_tick], without[k_tick]);
  parts.first_write_ns = model.system.can_write_ns * std::min(1, model.groups[k_tick].can_writes);
  parts.frame_to_can_deadline_ns = input.frame_to_can_deadline_ns;
  parts.age_deadline_ns = input.age_deadline_ns;
  add_bus(input, found, jitter_ns, parts);
  found.chains = chains_of(parts);
  for (const Chain& chain : found.chains) {
    check_deadline(found.missed_deadlines, "chain " + chain.name, chain.total_ns,
                   chain.deadline_ns);
  }
  return found;
}

}  // namespace glint
