// Judges a plan again from scratch, trusting nothing of what made it.
//
// What:     every node once and on a core that there is; what a core runs never overlaps; no node
//           starts before the data it reads is there (and handed over, from another core); no node
//           is given less time than its bound; at most one activation of a group is under way, so
//           that one buffer for each edge and one for each group's input suffice; the bus can carry
//           what is to be sent.
// Cost:     a few passes over nodes and edges.
// Source:   the model's own definition; it shares no code with the synthesis.
#pragma once

#include <string>
#include <vector>

#include "schedules/plan.hpp"
#include "schedules/task_model.hpp"

namespace glint {

// One line for each fault, naming group and node, what was found and what would fit. Empty: valid.
[[nodiscard]] std::vector<std::string> check_plan(const Plan& plan, const TaskModel& model);

}  // namespace glint
