// A plan as a file that a person can read and edit.
//
//   graph = "0x..+0x.."          # of every graph in it: a plan of other graphs is refused
//   board = "cortex-a72-emulated"
//   board_sha256 = "..."         # of the costs that the bounds come from
//   cores = 2
//
//   [bus]                        # what is to be sent at most, and on which bus
//   frames = "classic"           # or "fd"
//   bit_rate = 1000000
//   data_bit_rate = 4000000
//   tools = 1
//   tick_hz = 250
//
//   [[group]]
//   name = "frame"
//   priority = 45                # larger is more urgent
//   optimal = true               # no plan has a shorter makespan
//   least_possible_ns = 81200    # a bound on any plan's makespan from below
//   nodes = [                    # a core runs its nodes in the order of these lines
//     { node = "StampFrame", core = 0, start_ns = 0, bound_ns = 120 },
//     { node = "RoiThreshold#1", core = 1, start_ns = 900, bound_ns = 40000 },
//   ]
//
// Move a line or change its core, and leave out start_ns: it is then computed.
#pragma once

#include <string>

#include "schedules/plan.hpp"
#include "schedules/plan_check.hpp"
#include "schedules/task_model.hpp"

namespace glint {

// `signature` and the model's nodes are what the plan has to fit; bounds may differ, the board's
// check is check_plan(). Throws InputError: file:line, what was found, what was expected.
[[nodiscard]] Plan load_plan(const std::string& file, const TaskModel& model,
                             const std::string& signature);
[[nodiscard]] Plan plan_from_text(const std::string& text, const std::string& file,
                                  const TaskModel& model, const std::string& signature);

[[nodiscard]] std::string plan_text(const Plan& plan, const TaskModel& model);

}  // namespace glint
