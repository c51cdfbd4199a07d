// When each node of a group runs, given which core runs which nodes in which order.
//
// What:     start = the latest of: the core's node before it has ended; each node whose data it
//           reads has ended, a hand-over later where that was on another core. Longest path.
// Cost:     O(nodes + edges), times the number of nodes where the orders are tangled.
// Accuracy: exact for nodes that take their bound. Nodes that take less never end later: the
//           length of a longest path never falls when one of its weights grows.
// Source:   Graham 1969 shows why a *greedy* executor could end later with shorter nodes; fixed
//           orders cannot, which is why the runtime keeps to them.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "schedules/plan.hpp"
#include "schedules/task_model.hpp"

namespace glint {

struct OrderTimes {
  std::vector<std::int64_t> start_ns, end_ns;  // by the group's node index, from the release
  std::vector<int> core;                       // -1: in no order
  std::int64_t makespan_ns = 0;
  int cores_used = 0;
};

// Nothing where the orders and the data wait for each other.
[[nodiscard]] std::optional<OrderTimes> times_of(const TaskGroup& group,
                                                 const std::vector<std::vector<int>>& orders,
                                                 std::int64_t handover_ns);

}  // namespace glint
