// Worst-case response time of each group of a schedule: makespan, blocking and preemption.
//
// What:     R = J + w, w = makespan + B + wake-ups + sum over higher-priority groups and timer
//           interrupts, for each core that the group uses, of ceil((w + J_h) / T_h) C_h,core.
// Proof:    holds on several cores: a group's nodes have fixed orders, so its end is a longest path
//           through nodes (static_order.hpp). A preemption of length d delays only the node that
//           runs on that core, so it delays any path by at most d. A preemption of an idle core
//           delays nothing. All preemptions of all used cores together delay the end by at most
//           their sum. A higher-priority group on several cores occupies each of them, waiting
//           included, for at most its own response.
// Accuracy: exact on one core for independent releases; an upper bound on several. B counts one
//           slice of a lower-priority group per core as non-preemptive: pessimistic where a core
//           preempts it at once.
// Worst:    all higher-priority releases coincide with the group's own.
// Source:   response_time.hpp for the recurrence; the argument above is Glint's own.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "schedules/plan.hpp"
#include "schedules/static_order.hpp"
#include "schedules/task_model.hpp"

namespace glint {

struct GroupResponse {
  std::string name;
  int priority = 0;
  OrderTimes times;                         // without preemption, every node at its bound
  std::optional<std::int64_t> response_ns;  // from the nominal release; nothing: no bound exists
  std::int64_t blocking_ns = 0;
  std::int64_t jitter_ns = 0;
  std::int64_t deadline_ns = 0;

  [[nodiscard]] bool meets_deadline() const { return response_ns && *response_ns <= deadline_ns; }
};

// In the order of the model's groups. Uses the plan's orders and priorities, the model's bounds and
// system share. Requires a plan that passed check_plan(), except for its times.
[[nodiscard]] std::vector<GroupResponse> group_responses(const TaskModel& model, const Plan& plan);

}  // namespace glint
