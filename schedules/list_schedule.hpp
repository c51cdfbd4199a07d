// The reference of placement: list scheduling by level.
//
// What:     HLFET: of the nodes whose data is there, the one with the longest path of bounds to the
//           group's end goes next, to the core where it can start first.
// Cost:     O(n^2 m) for n nodes on m cores.
// Accuracy: at most (2 - 1/m) times the optimum without hand-over (Graham 1969); usually near it.
// Worst:    wide graphs of nodes that differ in length.
// Source:   Adam, Chandy, Dickson 1974, "HLFET"; hand-over as in Hwang, Chow, Anger, Lee 1989.
#pragma once

#include <cstdint>
#include <vector>

#include "schedules/task_model.hpp"

namespace glint {

using CoreOrders = std::vector<std::vector<int>>;  // by core: node indices in order

// The longest path of bounds from each node's start to the group's end, itself included.
[[nodiscard]] std::vector<std::int64_t> levels_of(const TaskGroup& group);

[[nodiscard]] CoreOrders list_schedule(const TaskGroup& group, int cores, std::int64_t handover_ns);

}  // namespace glint
