// Independent verification of a schedule.
//
// What:     every node occurs once, on an existing core; nodes on a core do not overlap; no node
//           starts before its input data is available (after the inter-core delay, from another
//           core); no node has less time than its bound; at most one activation of a group is
//           active, so that one buffer per edge and one per group input suffice; the bus can carry
//           the traffic.
// Cost:     a few passes over nodes and edges.
// Source:   the model's own definition; shares no code with the synthesis.
#pragma once

#include <string>
#include <vector>

#include "schedules/plan.hpp"
#include "schedules/task_model.hpp"

namespace glint {

// One line per fault: group and node, the value found and the value expected. Empty: valid.
[[nodiscard]] std::vector<std::string> check_plan(const Plan& plan, const TaskModel& model);

}  // namespace glint
