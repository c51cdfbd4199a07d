// The task model of a cell: the groups that `glint run` runs, what releases them and when they have
// to be done. Node and group indices are those of the graphs' orders of execution.
#pragma once

#include <string>

#include "platform/cells/cell.hpp"
#include "schedules/bus_load.hpp"
#include "schedules/cost_table.hpp"
#include "schedules/task_model.hpp"

namespace glint {

inline constexpr int k_frame_group_index = 0;  // in TaskModel::groups
inline constexpr int k_tick_group_index = 1;
inline constexpr int k_background_group_index = 2;  // where the cell has a background

// Groups, nodes and edges, rates and deadlines; every bound is 0 until a board gives it.
[[nodiscard]] TaskModel task_structure_of(const Cell& cell);

// The same with every node's bound on a board under given limits, and the system's share there.
// Throws InputError where the table does not price a node.
[[nodiscard]] TaskModel task_model_of(const Cell& cell, const CostTable& costs,
                                      const SystemShare& system, const Limits& limits);

// Of the graphs in that model, "0x..+0x..", one for each group: what plans are made for.
[[nodiscard]] std::string graphs_signature(const TaskModel& model);

// What one tick may write at most: poses, and all that comes beside them at once.
[[nodiscard]] int can_frames_per_tick_max(const Cell& cell, int tools);

[[nodiscard]] CanTraffic traffic_of(const Cell& cell);
[[nodiscard]] CanBitRates bit_rates_of(const Cell& cell);

}  // namespace glint
