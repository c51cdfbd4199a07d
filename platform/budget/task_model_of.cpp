#include "platform/budget/task_model_of.hpp"

#include <cstdio>

#include "graph/describe.hpp"
#include "nodes/mapper.hpp"
#include "nodes/output.hpp"
#include "nodes/tracker.hpp"
#include "platform/input_error.hpp"
#include "schedules/graph_group.hpp"

namespace glint {
namespace {

std::string signature_of(std::uint64_t signature) {
  char text[24];
  std::snprintf(text, sizeof text, "0x%016llx", static_cast<unsigned long long>(signature));
  return text;
}

}  // namespace

TaskModel task_structure_of(const Cell& cell) {
  TaskModel model;
  model.cores = cell.workers;
  TaskGroup frame;
  frame.name = "frame";
  frame.min_gap_ns = cell.camera.period.nanoseconds;
  frame.jitter_ns = cell.arrival_jitter.nanoseconds;
  frame.deadline_ns = cell.deadlines.frame.nanoseconds;
  frame.nodes = task_nodes_of<Tracker>();
  TaskGroup tick;
  tick.name = "tick";
  tick.min_gap_ns = shortest_tick_gap_of(cell).nanoseconds;
  tick.deadline_ns = cell.deadlines.tick.nanoseconds;
  tick.can_writes = can_frames_per_tick_max(cell, cell.tools.count);
  tick.nodes = task_nodes_of<Output>();
  model.groups = {frame, tick};
  if (cell.background) {
    TaskGroup background;
    background.name = "background";
    background.min_gap_ns = background.deadline_ns = cell.background->period.nanoseconds;
    background.resumable = true;
    background.nodes = task_nodes_of<Background>();
    model.groups.push_back(background);
  }
  return model;
}

TaskModel task_model_of(const Cell& cell, const CostTable& costs, const SystemShare& system,
                        const Limits& limits) {
  std::string_view missing = missing_cost<Tracker, Output>(costs);
  if (missing.empty() && cell.background) missing = missing_cost<Background>(costs);
  if (!missing.empty()) {
    throw InputError(std::string(costs.board) + ": no cost of " + std::string(missing) +
                     "; expected one of each of its loops");
  }
  TaskModel model = task_structure_of(cell);
  model.system = system;
  model.groups[k_tick_group_index].can_writes = can_frames_per_tick_max(cell, limits.tools);
  set_bounds<Tracker>(model.groups[k_frame_group_index], costs, limits);
  set_bounds<Output>(model.groups[k_tick_group_index], costs, limits);
  if (cell.background) {
    TaskGroup& background = model.groups[k_background_group_index];
    set_bounds<Background>(background, costs, limits);
    // An activation is one slice, without a preemption point before its end.
    for (const TaskNode& node : background.nodes) background.longest_slice_ns += node.bound_ns;
  }
  return model;
}

int can_frames_per_tick_max(const Cell& cell, int tools) {
  // In addition to the poses: a heartbeat, an emergency for each tool, the pair of time frames.
  return tools * can_frames_per_pose(cell.can.format) + 1 + tools + 2;
}

std::string graphs_signature(const TaskModel& model) {
  std::string text = signature_of(graph::Description<Tracker>::signature) + "+" +
                     signature_of(graph::Description<Output>::signature);
  if (model.groups.size() > k_background_group_index) {
    text.append("+").append(signature_of(graph::Description<Background>::signature));
  }
  return text;
}

CanTraffic traffic_of(const Cell& cell) {
  return {cell.tools.count, highest_tick_hz_of(cell), cell.can.format};
}

CanBitRates bit_rates_of(const Cell& cell) {
  return {static_cast<double>(cell.can.bit_rate), static_cast<double>(cell.can.data_bit_rate)};
}

}  // namespace glint
