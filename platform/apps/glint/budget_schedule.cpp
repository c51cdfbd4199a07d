// glint budget schedule: schedule synthesis for a cell on a board.
#include <cstdio>
#include <memory>
#include <string>

#include "platform/apps/glint/budget_commands.hpp"
#include "platform/apps/glint/cell_option.hpp"
#include "platform/apps/glint/output_file.hpp"
#include "platform/budget/check.hpp"
#include "platform/budget/expected_board.hpp"
#include "platform/budget/plan_file.hpp"
#include "platform/budget/slack_table.hpp"
#include "platform/budget/task_model_of.hpp"
#include "platform/budget/typical_load.hpp"
#include "platform/input_error.hpp"
#include "platform/printable.hpp"
#include "schedules/list_schedule.hpp"
#include "schedules/static_order.hpp"
#include "schedules/synthesis.hpp"

namespace glint {
namespace {

struct ScheduleArguments {
  std::string cell, board, out = "plan.toml", load = "bound", trace;
  int cores = 1;
};

int schedule(const ScheduleArguments& arguments) {
  const Cell cell = cell_or_default(arguments.cell);
  const Board board = load_board(arguments.board, expected_board(), BoardUse::analyse);
  const Limits limits = limits_of(cell);
  TaskModel model = task_model_of(cell, board.table(), board.system, limits);
  model.cores = arguments.cores;
  const bool typical = arguments.load == "typical";
  if (typical && arguments.trace.empty()) {
    throw InputError("--load typical: no --trace; expected the trace.spans of a typical run");
  }
  const TaskModel load = typical ? typical_load(model, arguments.trace) : model;

  Plan plan = synthesize(load);
  const Plan placed = plan;
  plan = with_computed_times(plan, model);
  plan.graph_signature = graphs_signature(model);
  plan.board = board.name;
  plan.board_sha256 = board.sha256;
  plan.traffic = traffic_of(cell);
  plan.traffic.tools = limits.tools;
  plan.bus = bit_rates_of(cell);
  for (std::size_t g = 0; typical && g < plan.groups.size(); ++g) {
    // Optimality was proven for the typical load, not for the bounds.
    plan.groups[g].optimal = false;
    plan.groups[g].makespan_lower_bound_ns =
        makespan_lower_bound(model.groups[g], model.cores, model.system.inter_core_delay_ns);
  }
  for (const std::string& fault : check_plan(plan, model))
    std::printf("FAILS    %s\n", printable(fault).c_str());
  write_text(arguments.out, plan_text(plan, model));

  std::printf("group        priority  makespan us  least us  list us  one core us  %s\n",
              typical ? "typical us" : "optimal");
  for (std::size_t g = 0; g < plan.groups.size(); ++g) {
    const std::int64_t core_delay = model.system.inter_core_delay_ns;
    const auto length = [&](int cores) {
      return times_of(model.groups[g], list_schedule(model.groups[g], cores, core_delay),
                      core_delay)
          ->makespan_ns;
    };
    const auto us = [](std::int64_t ns) { return static_cast<double>(ns) * 1e-3; };
    std::printf("%-12s %8d  %11.1f  %8.1f %8.1f  %11.1f  ", printable(plan.groups[g].name).c_str(),
                plan.groups[g].priority, us(plan.groups[g].makespan_ns),
                us(plan.groups[g].makespan_lower_bound_ns), us(length(model.cores)), us(length(1)));
    if (typical) {
      std::printf("%.1f\n", us(placed.groups[g].makespan_ns));
    } else {
      std::printf("%s\n", plan.groups[g].optimal ? "yes" : "not proven");
    }
  }
  const CheckInput input{cell, board, plan, limits, {}};
  std::printf("\n%s\n", printable_lines(slack_table(check(input, {}))).c_str());
  std::printf("written  %s\n", arguments.out.c_str());
  return check_plan(plan, model).empty() ? 0 : 1;
}

}  // namespace

void add_budget_schedule(CLI::App& budget, int& exit_code) {
  auto arguments = std::make_shared<ScheduleArguments>();
  CLI::App* command =
      budget.add_subcommand("schedule", "Assign each node to a core, with order and priority");
  add_cell_option(*command, arguments->cell);
  command->add_option("--board", arguments->board, "board file, or a built-in board's name")
      ->required();
  command->add_option("--cores", arguments->cores, "1, 2 or 4")
      ->check(CLI::IsMember({1, 2, 4}))
      ->capture_default_str();
  command->add_option("--load", arguments->load, "schedule for the bounds or for a typical load")
      ->check(CLI::IsMember({"bound", "typical"}))
      ->capture_default_str();
  command->add_option("--trace", arguments->trace, "trace.spans of a run with that load");
  command->add_option("--out", arguments->out, "plan file to write")->capture_default_str();
  command->footer(
      "Example: glint budget schedule --board cortex-a72-emulated --cores 2 --out plan.toml");
  command->callback([arguments, &exit_code] { exit_code = schedule(*arguments); });
}

}  // namespace glint
