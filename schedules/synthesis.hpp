// Schedule synthesis for all groups: allocation of nodes to cores, static orders and priorities.
//
// What:     each group alone gets the shortest makespan on the cores (exact_schedule.hpp). Groups
//           on one core are then tried on every core. The best allocation minimises the largest
//           ratio of response to deadline, then the second largest, and so on: a slice goes where
//           it blocks least. Priorities after Audsley: from the lowest up, each goes to the group
//           with the longest deadline that still meets it below all others. If none does, it goes
//           to the longest deadline (deadline monotonic). A resumable group gets the lowest
//           priority whatever its deadline.
// Cost:     one search per group; (cores to the power of the number of one-core groups) analyses,
//           at most 64.
// Source:   Audsley 1991 (optimal priorities); Leung and Whitehead 1982 (deadline monotonic).
#pragma once

#include "schedules/exact_schedule.hpp"
#include "schedules/plan.hpp"
#include "schedules/task_model.hpp"

namespace glint {

// SCHED_FIFO scale, below the kernel's interrupt threads (50). Ranks are k_priority_step apart.
inline constexpr int k_priority_max = 48;
inline constexpr int k_priority_step = 3;
inline constexpr int k_plan_cores_max = 4;

// For model.cores cores, at most k_plan_cores_max. The caller sets signature, board and bus.
[[nodiscard]] Plan synthesize(const TaskModel& model,
                              std::int64_t search_nodes_max = k_search_nodes_max);

// The same plan with starts, ends and makespans from the model's bounds. Requires feasible orders.
[[nodiscard]] Plan with_computed_times(const Plan& plan, const TaskModel& model);

}  // namespace glint
