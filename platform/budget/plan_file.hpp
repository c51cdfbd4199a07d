// Schedule file: an editable text form of a static schedule.
//
//   graph = "0x..+0x.."          # signatures of all its graphs; others are rejected
//   board = "cortex-a72-emulated"
//   board_sha256 = "..."         # of the costs behind the bounds
//   cores = 2
//
//   [bus]                        # maximum traffic, and the bus
//   frames = "classic"           # or "fd"
//   bit_rate = 1000000
//   data_bit_rate = 4000000
//   tools = 1
//   tick_hz = 250
//
//   [[group]]
//   name = "frame"
//   priority = 45                # larger number: higher priority
//   optimal = true               # no schedule has a shorter makespan
//   least_possible_ns = 81200    # lower bound of every schedule's makespan
//   nodes = [                    # a core runs its nodes in the order of these lines
//     { node = "StampFrame", core = 0, start_ns = 0, bound_ns = 120 },
//     { node = "RoiThreshold#1", core = 1, start_ns = 900, bound_ns = 40000 },
//   ]
//
// To edit, move a line or change its core, and omit start_ns: it is then computed.
#pragma once

#include <string>

#include "schedules/plan.hpp"
#include "schedules/plan_check.hpp"
#include "schedules/task_model.hpp"

namespace glint {

// Requires a schedule for the graphs with `signature` and for the model's nodes. Its bounds may
// differ: check_plan() compares them with the board's. Throws InputError: file:line, what was
// found, what was expected.
[[nodiscard]] Plan load_plan(const std::string& file, const TaskModel& model,
                             const std::string& signature);
[[nodiscard]] Plan plan_from_text(const std::string& text, const std::string& file,
                                  const TaskModel& model, const std::string& signature);

[[nodiscard]] std::string plan_text(const Plan& plan, const TaskModel& model);

}  // namespace glint
