// Nodes of a graph as a group of the task model: names, copies, predecessors, and their bounds on a
// board. For any graph, also one with nodes of another project.
//
// Cost:     a copy of the wiring; not for the run path.
// Accuracy: the bounds are those of node_bounds.hpp.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "graph/describe.hpp"
#include "graph/plan_tables.hpp"
#include "schedules/node_bounds.hpp"
#include "schedules/task_model.hpp"

namespace glint {

// In the order of execution; every bound is 0.
template <class G>
[[nodiscard]] std::vector<TaskNode> task_nodes_of() {
  std::vector<TaskNode> nodes;
  for (const graph::NodeInfo& info : graph::Description<G>::nodes) {
    TaskNode node;
    node.name = std::string(info.name);
    node.copy = info.copy;
    node.copies = info.copies;
    const graph::NodeSet needed = graph::predecessors<G>[nodes.size()];
    for (int before = 0; before < G::node_count; ++before) {
      if ((needed >> before & 1U) != 0) node.after.push_back(before);
    }
    nodes.push_back(node);
  }
  return nodes;
}

// Requires the nodes of task_nodes_of<G>(), and costs of each: missing_cost<G>(costs) is empty.
template <class G>
void set_bounds(TaskGroup& group, const CostTable& costs, const Limits& limits) {
  const auto bounds = node_bounds<G>(costs, limits);
  for (std::size_t n = 0; n < bounds.size(); ++n) group.nodes[n].bound_ns = bounds[n];
}

}  // namespace glint
