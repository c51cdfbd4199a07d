// Static schedule of all groups: allocation of nodes to cores and their order. Written by the
// synthesis, executed by the runtime.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "schedules/bus_load.hpp"
#include "schedules/task_model.hpp"

namespace glint {

// Allocation of one node. On a core, the nodes of one group run in the order of `start_ns`.
struct PlannedNode {
  int group = 0;  // index into the task model's groups
  int node = 0;   // index into that group's nodes
  int core = 0;
  std::int64_t start_ns = 0;  // from the group's release, without preemption, nodes at their bounds
  std::int64_t end_ns = 0;
};

struct PlannedGroup {
  std::string name;
  int priority = 0;
  std::int64_t makespan_ns = 0;
  std::int64_t makespan_lower_bound_ns = 0;  // a lower bound on any schedule's makespan
  bool optimal = false;                      // makespan_ns is proven to be the optimum
};

struct Plan {
  std::string graph_signature;  // of all its graphs, "0x.." joined by '+'
  std::string board;            // name of the board file
  std::string board_sha256;     // of the costs used for the bounds
  int cores = 1;
  CanTraffic traffic;  // the traffic and the bus for which the plan was made
  CanBitRates bus;
  std::vector<PlannedGroup> groups;
  std::vector<PlannedNode> nodes;
};

// "FindBlobs", or "RoiThreshold#1" for a copy of a split node.
[[nodiscard]] std::string node_name(const TaskNode& node);

// The nodes of one group per core, in execution order: indices into the group's nodes, which are
// the graph's node indices. One list per core of the plan.
[[nodiscard]] std::vector<std::vector<int>> core_orders(const Plan& plan, int group);

}  // namespace glint
