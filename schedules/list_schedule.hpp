// List scheduling by level (HLFET): the reference algorithm for node allocation.
//
// What:     of the ready nodes, schedules the one with the longest path of bounds to the group's
//           end, on the core where it can start first.
// Cost:     O(n^2 m) for n nodes on m cores.
// Accuracy: at most (2 - 1/m) times the optimum without inter-core delay (Graham 1969); usually
//           near it.
// Worst:    wide graphs of nodes of different lengths.
// Source:   Adam, Chandy, Dickson 1974, "HLFET"; inter-core delay as in Hwang, Chow, Anger, Lee
//           1989.
#pragma once

#include <cstdint>
#include <vector>

#include "schedules/task_model.hpp"

namespace glint {

using CoreOrders = std::vector<std::vector<int>>;  // per core: node indices in order

// Longest path of bounds from each node's start to the group's end, the node included.
[[nodiscard]] std::vector<std::int64_t> levels_of(const TaskGroup& group);

[[nodiscard]] CoreOrders list_schedule(const TaskGroup& group, int cores,
                                       std::int64_t inter_core_delay_ns);

}  // namespace glint
