// Which node runs on which core, and in which order: what synthesis makes and the runtime follows.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "schedules/bus_load.hpp"
#include "schedules/task_model.hpp"

namespace glint {

// One node's place. On a core, the nodes of one group run in the order of `start_ns`.
struct PlannedNode {
  int group = 0;  // index into the task model's groups
  int node = 0;   // index into that group's nodes
  int core = 0;
  std::int64_t start_ns = 0;  // from the group's release, every node at its bound, undisturbed
  std::int64_t end_ns = 0;
};

struct PlannedGroup {
  std::string name;
  int priority = 0;
  std::int64_t makespan_ns = 0;
  std::int64_t least_possible_ns = 0;  // a lower bound on any plan's makespan
  bool optimal = false;                // makespan == the optimum, proven
};

struct Plan {
  std::string graph_signature;  // of every graph in it, "0x.." joined by '+'
  std::string board;            // name of the board file
  std::string board_sha256;     // of the costs that the bounds come from
  int cores = 1;
  CanTraffic traffic;  // what the plan was made to send, and the bus that it was made for
  CanBitRates bus;
  std::vector<PlannedGroup> groups;
  std::vector<PlannedNode> nodes;
};

// "FindBlobs", or "RoiThreshold#1" for a copy of a split.
[[nodiscard]] std::string node_name(const TaskNode& node);

// The nodes of one group that each core runs, in its order: indices into the group's nodes, which
// are the graph's numbers in its order of execution. As many lists as the plan has cores.
[[nodiscard]] std::vector<std::vector<int>> core_orders(const Plan& plan, int group);

}  // namespace glint
