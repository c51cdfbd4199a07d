// Allocation of nodes to cores, priorities and time bounds of a run, from a board file and a
// schedule. Without them: the rule of graph/workers.hpp, any core, and no bounds.
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
struct GroupSchedule {
  graph::ScheduleTables<G> tables = graph::default_schedule<G>(1);
  std::vector<int> cores = {-1};           // by worker; -1: any
  int priority = 0;                        // SCHED_FIFO
  std::vector<std::int64_t> bounds_ns;     // by node; empty: no board file
  std::vector<std::int64_t> remaining_ns;  // by node: from its end to the group's, worst case
};

struct RunSchedule {
  bool planned = false;  // by a schedule file
  std::string board, plan_file;
  // In microseconds; 0: no board file.
  double frame_bound_us = 0, tick_bound_us = 0, frame_to_can_bound_us = 0, background_bound_us = 0;
  std::vector<std::string> caveats;  // why these bounds may not hold
  GroupSchedule<Tracker> frame;
  GroupSchedule<Output> tick;
  std::optional<GroupSchedule<Background>> background;  // if the cell has one
};

// Fixed priorities: on each core, tick preempts frame and frame preempts background. All are below
// the kernel's interrupt threads (50).
inline constexpr int k_tick_priority = 48;
inline constexpr int k_frame_priority = 45;
inline constexpr int k_background_priority = 42;
// Priority of a thread that simulates the camera's driver.
inline constexpr int k_arrival_priority = k_tick_priority + 1;

// Worst-case remaining time after each node, if one worker runs all nodes in the graph's order.
[[nodiscard]] std::vector<std::int64_t> remaining_in_order(
    const std::vector<std::int64_t>& bounds_ns);

// Schedule by rule, for the cell's number of workers.
[[nodiscard]] RunSchedule schedule_by_rule(const Cell& cell);

// Converts a checked schedule: its first group is the tracker's, the second the output's, the
// optional third the background's. Throws InputError naming `file` if a worker would wait for ever.
[[nodiscard]] RunSchedule schedule_of(const Plan& plan, const TaskModel& model,
                                      const std::string& file);

}  // namespace glint
