// What a board and a plan tell a run: who runs which node where, at which priority, and within
// which bounds. Without them: the rule of graph/workers.hpp, any core, and no bound.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "graph/plan_tables.hpp"
#include "nodes/mapper.hpp"
#include "nodes/output.hpp"
#include "nodes/tracker.hpp"
#include "platform/cells/cell.hpp"
#include "schedules/plan.hpp"
#include "schedules/task_model.hpp"

namespace glint {

template <class G>
struct GroupPlan {
  graph::PlanTables<G> tables = graph::plan_by_rule<G>(1);
  std::vector<int> cores = {-1};           // of each worker; -1: any
  int priority = 0;                        // SCHED_FIFO
  std::vector<std::int64_t> bounds_ns;     // by node; empty: no board
  std::vector<std::int64_t> remaining_ns;  // by node: from its end to the group's, at worst
};

struct RunPlan {
  bool planned = false;  // by a plan file
  std::string board, plan_file;
  // In microseconds; 0: no board.
  double frame_bound_us = 0, tick_bound_us = 0, frame_to_can_bound_us = 0, background_bound_us = 0;
  std::vector<std::string> doubts;  // why these bounds promise less than they say
  GroupPlan<Tracker> frame;
  GroupPlan<Output> tick;
  std::optional<GroupPlan<Background>> background;  // where the cell has one
};

// Fixed priorities: on a core, tick preempts frame preempts background. Below the kernel's
// interrupt threads (50).
inline constexpr int k_tick_priority = 48;
inline constexpr int k_frame_priority = 45;
inline constexpr int k_background_priority = 42;
// Of a thread that stands in for the camera's driver.
inline constexpr int k_arrival_priority = k_tick_priority + 1;

// What may be needed at worst after each node, where one worker runs them all in the graph's order.
[[nodiscard]] std::vector<std::int64_t> remaining_in_order(
    const std::vector<std::int64_t>& bounds_ns);

// By rule, for the cell's number of workers.
[[nodiscard]] RunPlan plan_by_rule(const Cell& cell);

// As a checked plan says: its first group is the tracker's, its second the output's, a
// third one the background's. Throws InputError naming `file` where a worker would wait for ever.
[[nodiscard]] RunPlan plan_of(const Plan& plan, const TaskModel& model, const std::string& file);

}  // namespace glint
