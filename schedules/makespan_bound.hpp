// Lower bounds on the time from a node's start to the end of its group, for any schedule.
#pragma once

#include <cstdint>
#include <vector>

#include "schedules/task_model.hpp"

namespace glint {

// reach[u][v]: v depends, directly or not, on the output of u.
using Reach = std::vector<std::vector<bool>>;
[[nodiscard]] Reach reach_of(const TaskGroup& group);

// Minimum time between u's end and v's start for the work between them: `work_ns` on up to `cores`
// cores, all but one of which lose two inter-core delays.
[[nodiscard]] std::int64_t time_between_min(std::int64_t work_ns, int cores,
                                            std::int64_t inter_core_delay_ns);

// Per node, itself included. At least the longest path.
[[nodiscard]] std::vector<std::int64_t> tails_of(const TaskGroup& group, const Reach& reach,
                                                 int cores, std::int64_t inter_core_delay_ns);

}  // namespace glint
