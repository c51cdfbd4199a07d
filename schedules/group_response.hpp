// How late each group of a plan may be done: its makespan, and what may be put before it.
//
// What:     R = J + w, w = makespan + B + wake-ups + sum over more urgent groups and timer
//           interrupts, for each core that the group uses, of ceil((w + J_h) / T_h) C_h,core.
// Why that is safe on several cores: a group's nodes keep fixed orders, so its end is a longest
//           path through nodes (static_order.hpp). A preemption of length d on one core delays the
//           one node that runs there by d and so any path by at most d; a preemption of a core that
//           waits delays nothing. All preemptions of all used cores together therefore delay the
//           end by at most their sum. A more urgent group that spans several cores holds each of
//           them, waiting included, for no longer than its own response.
// Accuracy: exact on one core for independent releases; an upper bound on several. B counts one
//           slice of a less urgent group a core as if nothing could interrupt it: more than happens
//           where a core preempts it at once.
// Worst:    all more urgent releases together with the group's own.
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
  OrderTimes times;                         // undisturbed, every node at its bound
  std::optional<std::int64_t> response_ns;  // from the nominal release; nothing: no bound exists
  std::int64_t blocking_ns = 0;
  std::int64_t jitter_ns = 0;
  std::int64_t deadline_ns = 0;

  [[nodiscard]] bool in_time() const { return response_ns && *response_ns <= deadline_ns; }
};

// In the order of the model's groups. Orders and priorities are the plan's, bounds and the system's
// share the model's. The plan must have passed check_plan() but for its times.
[[nodiscard]] std::vector<GroupResponse> group_responses(const TaskModel& model, const Plan& plan);

}  // namespace glint
