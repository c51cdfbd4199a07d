// Optimal makespan of a node graph on several cores (multiprocessor scheduling) by branch and
// bound.
//
// What:     appends nodes to cores in the order of their starts. Every semi-active schedule is such
//           a sequence, and an optimal one is among them. Pruned are: sequences no better than the
//           best found (bounds below); all but the first of interchangeable copies; all but the
//           first of the unused cores.
// Bounds:   paths; total work over all cores; and between a node u and a later node v, the work S
//           between them on j of the m cores. All but one core lose two inter-core delays h:
//             start_v - end_u >= min over j <= m of (S + 2 h (j - 1)) / j.
// Cost:     exponential in principle; at most k_search_nodes_max sequences. Then returns the best
//           schedule found, with the lower bound. Glint's tracker needs some hundreds.
// Worst:    many different independent nodes.
// Accuracy: `optimal` is proven: the search was exhausted, or the lower bound was reached.
// Source:   Kohler and Steiglitz 1974 (branch and bound over semi-active sequences); the bound
//           above extends Fernandez and Bussell 1973 by inter-core delays.
#pragma once

#include <cstdint>

#include "schedules/list_schedule.hpp"
#include "schedules/task_model.hpp"

namespace glint {

inline constexpr std::int64_t k_search_nodes_max = 2'000'000;

struct ExactSchedule {
  CoreOrders orders;
  std::int64_t makespan_ns = 0;
  std::int64_t makespan_lower_bound_ns = 0;  // lower bound of every schedule's makespan
  bool optimal = false;
  std::int64_t searched = 0;
};

[[nodiscard]] ExactSchedule exact_schedule(const TaskGroup& group, int cores,
                                           std::int64_t inter_core_delay_ns,
                                           std::int64_t search_nodes_max = k_search_nodes_max);

// Lower bound on the makespan of any schedule.
[[nodiscard]] std::int64_t makespan_lower_bound(const TaskGroup& group, int cores,
                                                std::int64_t inter_core_delay_ns);

}  // namespace glint
