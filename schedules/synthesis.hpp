// A plan for all groups: who runs where, in which order, at which priority.
//
// What:     each group alone gets the shortest makespan on the cores (exact_schedule.hpp); groups
//           that use one core are then tried on every core, and the placement is kept whose
//           tightest response is the best against its deadline, then the second tightest, and so
//           on: a slice goes where it blocks least. Priorities after Audsley: from the least urgent
//           up, each goes to the group with the longest deadline that still meets it below all
//           others; where none does, to the longest deadline (deadline monotonic). A resumable
//           group is given the lowest priority whatever its deadline.
// Cost:     one search a group; (cores to the number of one-core groups) analyses, at most 64.
// Source:   Audsley 1991 (optimal priorities); Leung and Whitehead 1982 (deadline monotonic).
#pragma once

#include "schedules/exact_schedule.hpp"
#include "schedules/plan.hpp"
#include "schedules/task_model.hpp"

namespace glint {

// SCHED_FIFO's scale, below the kernel's interrupt threads (50). The next group is three lower.
inline constexpr int k_most_urgent_priority = 48;
inline constexpr int k_priority_step = 3;
inline constexpr int k_plan_cores_max = 4;

// For model.cores cores, at most k_plan_cores_max. Signature, board and bus are left to the caller.
[[nodiscard]] Plan synthesize(const TaskModel& model,
                              std::int64_t search_nodes_max = k_search_nodes_max);

// The same plan with starts, ends and makespans of the model's bounds. Its orders must be possible.
[[nodiscard]] Plan retimed(const Plan& plan, const TaskModel& model);

}  // namespace glint
