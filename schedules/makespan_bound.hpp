// From below: how much time must pass from a node's start to the end of its group, on any schedule.
#pragma once

#include <cstdint>
#include <vector>

#include "schedules/task_model.hpp"

namespace glint {

// reach[u][v]: v needs, directly or not, what u makes.
using Reach = std::vector<std::vector<bool>>;
[[nodiscard]] Reach reach_of(const TaskGroup& group);

// The least time between u's end and v's start that the work between them allows: `work_ns` on up
// to `cores` cores, all but one of which pay two hand-overs.
[[nodiscard]] std::int64_t least_between(std::int64_t work_ns, int cores, std::int64_t handover_ns);

// By node, itself included. At least the plain longest path.
[[nodiscard]] std::vector<std::int64_t> tails_of(const TaskGroup& group, const Reach& reach,
                                                 int cores, std::int64_t handover_ns);

}  // namespace glint
