// Start and end times of the nodes of a group under a static order per core.
//
// What:     start = the latest of: end of the previous node on the core; end of each predecessor,
//           plus the inter-core delay if it ran on another core. Longest path.
// Cost:     O(nodes + edges), times the number of nodes if the orders interleave.
// Accuracy: exact for nodes that take their bound. Shorter nodes never end later: the length of a
//           longest path never falls when a weight grows.
// Source:   Graham 1969 shows that under a *greedy* executor shorter nodes may end later; under
//           fixed orders they cannot, so the runtime uses fixed orders.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "schedules/plan.hpp"
#include "schedules/task_model.hpp"

namespace glint {

struct OrderTimes {
  std::vector<std::int64_t> start_ns, end_ns;  // by node index of the group, from the release
  std::vector<int> core;                       // -1: in no order
  std::int64_t makespan_ns = 0;
  int cores_used = 0;
};

// Returns nothing if the orders and the data dependencies form a cycle.
[[nodiscard]] std::optional<OrderTimes> times_of(const TaskGroup& group,
                                                 const std::vector<std::vector<int>>& orders,
                                                 std::int64_t inter_core_delay_ns);

}  // namespace glint
