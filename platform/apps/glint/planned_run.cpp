#include "platform/apps/glint/planned_run.hpp"

#include "platform/budget/check.hpp"
#include "platform/budget/expected_board.hpp"
#include "platform/budget/task_model_of.hpp"
#include "platform/input_error.hpp"

namespace glint {
namespace {

// Returns 0 if absent.
double microseconds_of(std::optional<std::int64_t> ns) {
  return static_cast<double>(ns.value_or(0)) * 1e-3;
}

}  // namespace

RunSchedule planned_run(const Cell& cell, const std::string& board_name,
                        const std::string& plan_file) {
  if (board_name.empty() && plan_file.empty()) return schedule_by_rule(cell);
  if (board_name.empty() || plan_file.empty()) {
    throw InputError("--board \"" + board_name + "\" and --plan \"" + plan_file +
                     "\": expected both: a plan holds only with one board's costs");
  }
  const Board board = load_board(board_name, expected_board(), BoardUse::run_here);
  CheckInput input{cell, board, {}, limits_of(cell), {}};
  TaskModel model = task_model_of(cell, board.table(), board.system, input.limits);
  input.plan = validated_plan(plan_file, model, input.limits);
  RunSchedule plan = schedule_of(input.plan, model, plan_file);
  const CheckResult result = check(input, {});
  for (const Chain& chain : result.assessment.chains) {
    if (chain.name == "frame_to_can") plan.frame_to_can_bound_us = microseconds_of(chain.total_ns);
  }
  plan.caveats = invalid_reasons(input, result);
  plan.caveats.insert(plan.caveats.end(), result.fails.begin(), result.fails.end());
  plan.frame_bound_us = microseconds_of(result.assessment.groups.at(0).response_ns);
  plan.tick_bound_us = microseconds_of(result.assessment.groups.at(1).response_ns);
  if (plan.background) {
    plan.background_bound_us = microseconds_of(result.assessment.groups.at(2).response_ns);
  }
  return plan;
}

}  // namespace glint
