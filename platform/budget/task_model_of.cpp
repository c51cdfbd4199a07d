#include "platform/budget/task_model_of.hpp"

#include <cstdio>

#include "graph/describe.hpp"
#include "graph/plan_tables.hpp"
#include "nodes/output.hpp"
#include "nodes/tracker.hpp"

namespace glint {
namespace {

template <class G>
std::vector<TaskNode> nodes_of() {
  std::vector<TaskNode> nodes;
  for (const graph::NodeInfo& info : graph::Description<G>::nodes) {
    TaskNode node;
    node.name = std::string(info.name);
    node.copy = info.copy;
    node.copies = info.copies;
    const graph::NodeSet needed = graph::needs<G>[nodes.size()];
    for (int before = 0; before < G::node_count; ++before) {
      if ((needed >> before & 1U) != 0) node.after.push_back(before);
    }
    nodes.push_back(node);
  }
  return nodes;
}

std::string signature_of(std::uint64_t signature) {
  char text[24];
  std::snprintf(text, sizeof text, "0x%016llx", static_cast<unsigned long long>(signature));
  return text;
}

std::int64_t tick_period_ns(const Cell& cell) {
  return static_cast<std::int64_t>(1e9 / cell.tick_hz);
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
  frame.nodes = nodes_of<Tracker>();
  TaskGroup tick;
  tick.name = "tick";
  tick.min_gap_ns = tick_period_ns(cell);
  tick.deadline_ns = cell.deadlines.tick.nanoseconds;
  tick.can_writes = can_frames_per_tick_max(cell);
  tick.nodes = nodes_of<Output>();
  model.groups = {frame, tick};
  return model;
}

int can_frames_per_tick_max(const Cell& cell) {
  constexpr int k_classic_pose_frames = 5;
  // Beside the poses: a heartbeat, an emergency for each tool, the pair of time frames.
  return cell.tools.count * (cell.can.fd ? 1 : k_classic_pose_frames) + 1 + cell.tools.count + 2;
}

std::string graphs_signature() {
  return signature_of(graph::Description<Tracker>::signature) + "+" +
         signature_of(graph::Description<Output>::signature);
}

CanTraffic traffic_of(const Cell& cell) {
  return {cell.tools.count, cell.tick_hz, cell.can.fd ? CanFormat::fd : CanFormat::classic};
}

CanBitRates bit_rates_of(const Cell& cell) {
  return {static_cast<double>(cell.can.bit_rate), static_cast<double>(cell.can.data_bit_rate)};
}

}  // namespace glint
