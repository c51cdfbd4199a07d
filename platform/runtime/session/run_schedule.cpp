#include "platform/runtime/session/run_schedule.hpp"

#include <algorithm>
#include <map>

#include "graph/describe.hpp"
#include "platform/input_error.hpp"

namespace glint {
namespace {

std::string name_of_node(const graph::NodeInfo& node) {
  std::string name(node.name);
  return node.copies > 1 ? name + "#" + std::to_string(node.copy) : name;
}

// The schedule's nodes of one group, in order of their start times.
std::vector<PlannedNode> in_order(const Plan& plan, int group) {
  std::vector<PlannedNode> nodes;
  for (const PlannedNode& node : plan.nodes) {
    if (node.group == group) nodes.push_back(node);
  }
  std::stable_sort(nodes.begin(), nodes.end(), [](const PlannedNode& a, const PlannedNode& b) {
    return a.start_ns < b.start_ns;
  });
  return nodes;
}

template <class G>
GroupSchedule<G> group_plan(const Plan& plan, const TaskModel& model, int group,
                            const std::string& file) {
  const auto g = static_cast<std::size_t>(group);
  GroupSchedule<G> result;
  result.priority = plan.groups.at(g).priority;
  const std::vector<PlannedNode> nodes = in_order(plan, group);
  // Worker 0 is the core of the graph's first node, since an activation begins there.
  std::map<int, int> worker_of_core;
  result.cores.clear();
  const auto worker_of = [&](int core) {
    const auto [it, is_new] =
        worker_of_core.try_emplace(core, static_cast<int>(result.cores.size()));
    if (is_new) result.cores.push_back(core);
    return it->second;
  };
  std::int64_t end_ns = 0;
  for (const PlannedNode& node : nodes) {
    if (node.node == 0) (void)worker_of(node.core);
    end_ns = std::max(end_ns, node.end_ns);
  }
  for (const PlannedNode& node : nodes) (void)worker_of(node.core);
  result.tables = {};
  result.tables.workers =
      std::min<int>(static_cast<int>(result.cores.size()), graph::k_plan_workers_max);
  result.bounds_ns.assign(static_cast<std::size_t>(G::node_count), 0);
  result.remaining_ns.assign(static_cast<std::size_t>(G::node_count), 0);
  for (const PlannedNode& node : nodes) {
    if (!result.tables.add(node.node, worker_of(node.core))) continue;  // reported as a fault below
    const auto n = static_cast<std::size_t>(node.node);
    result.bounds_ns[n] = model.groups.at(g).nodes.at(n).bound_ns;
    result.remaining_ns[n] = end_ns - node.end_ns;
  }
  if (const graph::PlanFault fault = graph::schedule_fault(result.tables); fault.found()) {
    const std::string node =
        fault.node >= 0
            ? name_of_node(graph::Description<G>::nodes[static_cast<std::size_t>(fault.node)])
            : "a node";
    throw InputError(
        file + ": group \"" + plan.groups.at(g).name + "\": " + node +
        " cannot run as planned; expected every node once, after its inputs, on at most " +
        std::to_string(graph::k_plan_workers_max) + " cores");
  }
  return result;
}

}  // namespace

std::vector<std::int64_t> remaining_in_order(const std::vector<std::int64_t>& bounds_ns) {
  std::vector<std::int64_t> remaining_ns(bounds_ns.size());
  std::int64_t after_ns = 0;
  for (std::size_t node = bounds_ns.size(); node-- > 0;) {
    remaining_ns[node] = after_ns;
    after_ns += bounds_ns[node];
  }
  return remaining_ns;
}

RunSchedule schedule_by_rule(const Cell& cell) {
  RunSchedule plan;
  plan.frame.tables = graph::default_schedule<Tracker>(cell.workers);
  plan.frame.cores.assign(static_cast<std::size_t>(cell.workers), -1);
  plan.frame.priority = k_frame_priority;
  plan.tick.priority = k_tick_priority;
  if (cell.background) plan.background.emplace().priority = k_background_priority;
  return plan;
}

RunSchedule schedule_of(const Plan& plan, const TaskModel& model, const std::string& file) {
  if (plan.groups.size() < 2) {
    throw InputError(file + ": found " + std::to_string(plan.groups.size()) +
                     " groups; expected \"frame\" and \"tick\"");
  }
  RunSchedule result;
  result.planned = true;
  result.board = plan.board;
  result.plan_file = file;
  result.frame = group_plan<Tracker>(plan, model, 0, file);
  result.tick = group_plan<Output>(plan, model, 1, file);
  result.frame_bound_us = static_cast<double>(plan.groups[0].makespan_ns) * 1e-3;
  result.tick_bound_us = static_cast<double>(plan.groups[1].makespan_ns) * 1e-3;
  if (plan.groups.size() > 2) {
    result.background = group_plan<Background>(plan, model, 2, file);
    result.background_bound_us = static_cast<double>(plan.groups[2].makespan_ns) * 1e-3;
  }
  return result;
}

}  // namespace glint
