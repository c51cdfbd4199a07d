// Task model of a cell: the groups of `glint run`, their releases and deadlines. Indices of groups
// and nodes are those of the graphs' orders of execution.
#pragma once

#include <string>

#include "platform/cells/cell.hpp"
#include "schedules/bus_load.hpp"
#include "schedules/cost_table.hpp"
#include "schedules/task_model.hpp"

namespace glint {

inline constexpr int k_frame_group_index = 0;  // in TaskModel::groups
inline constexpr int k_tick_group_index = 1;
inline constexpr int k_background_group_index = 2;  // if the cell has a background

// Groups, nodes, edges, rates and deadlines; every bound is 0 until a board's costs are applied.
[[nodiscard]] TaskModel task_structure_of(const Cell& cell);

// The same with every node's bound from the cost table under the given limits, and with the
// system's share. Throws InputError if the table lacks a node.
[[nodiscard]] TaskModel task_model_of(const Cell& cell, const CostTable& costs,
                                      const SystemShare& system, const Limits& limits);

// Signatures of the graphs in the model, "0x..+0x..", one per group; a schedule is made for them.
[[nodiscard]] std::string graphs_signature(const TaskModel& model);

// Maximum number of CAN frames written in one tick: poses and all others at once.
[[nodiscard]] int can_frames_per_tick_max(const Cell& cell, int tools);

[[nodiscard]] CanTraffic traffic_of(const Cell& cell);
[[nodiscard]] CanBitRates bit_rates_of(const Cell& cell);

}  // namespace glint
