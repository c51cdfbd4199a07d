// glint budget check: response-time analysis of a schedule on a board, before it runs.
#include <algorithm>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "platform/apps/glint/budget_commands.hpp"
#include "platform/apps/glint/cell_option.hpp"
#include "platform/apps/glint/measure_request.hpp"
#include "platform/apps/glint/output_file.hpp"
#include "platform/budget/bus_frames.hpp"
#include "platform/budget/check.hpp"
#include "platform/budget/expected_board.hpp"
#include "platform/budget/prove/proved_code.hpp"
#include "platform/budget/task_model_of.hpp"
#include "platform/in_range.hpp"
#include "platform/input_error.hpp"
#include "platform/printable.hpp"

namespace glint {
namespace {

struct CheckArguments {
  std::string cell, board, plan, json, proof, program = "/proc/self/exe";
  std::vector<std::string> scale;
  CheckOptions options;
};

// "FindBlobs=1.3"
void add_scale(const std::string& text, CheckOptions& options) {
  const std::size_t at = text.find('=');
  char* end = nullptr;
  const double factor = at == std::string::npos ? 0 : std::strtod(text.c_str() + at + 1, &end);
  if (at == std::string::npos || end == text.c_str() + at + 1 || *end != '\0' ||
      !(factor > 0 && factor <= 1000)) {
    throw InputError("--scale " + text + ": expected NODE=FACTOR with a factor up to 1000");
  }
  options.scale[text.substr(0, at)] = factor;
}

int run_check(const CheckArguments& arguments) {
  const Cell cell = cell_or_default(arguments.cell);
  const Board board = load_board(arguments.board, expected_board(), BoardUse::analyse);
  CheckOptions options = arguments.options;
  for (const std::string& scale : arguments.scale) add_scale(scale, options);

  CheckInput input{cell, board, {}, limits_of(cell), {}};
  TaskModel model = task_model_of(cell, board.table(), board.system, input.limits);
  input.plan = validated_plan(arguments.plan, model, input.limits);
  if (!options.foreign.empty()) {
    input.foreign = foreign_frames(options.foreign, own_frames_of(cell, input.limits.tools));
  }

  if (!arguments.proof.empty()) {
    options.proved = prove::bounds_of_program(load_proofs(arguments.proof), arguments.program);
  }

  const CheckResult result = check(input, options);
  std::fputs(printable_lines(check_table(input, result)).c_str(), stdout);
  const auto observed = [](const std::string& fail) {
    return fail.find(": observed ") != std::string::npos;
  };
  if (std::any_of(result.fails.begin(), result.fails.end(), observed)) {
    std::fputs(advice_above_bound(board.counter, board.provenance.command).c_str(), stdout);
  }
  nlohmann::ordered_json json = check_json(input, options, result);
  json["plan"] = arguments.plan;
  write_json(arguments.json, json);
  return result.fails.empty() ? 0 : 1;
}

}  // namespace

void add_budget_check(CLI::App& budget, int& exit_code) {
  auto arguments = std::make_shared<CheckArguments>();
  CheckOptions& options = arguments->options;
  CLI::App* command = budget.add_subcommand(
      "check", "Compute response times, chains, bus load and slack of a plan on a board");
  add_cell_option(*command, arguments->cell);
  command->add_option("--board", arguments->board, "board file, or a built-in board's name")
      ->required();
  command->add_option("--plan", arguments->plan, "plan file of `glint budget schedule`")
      ->required();
  command->add_option("--foreign", options.foreign, "file of other nodes' CAN frames");
  command->add_option("--scale", arguments->scale, "NODE=FACTOR: this node is FACTOR times slower");
  command->add_option("--clock", options.clock, "clock as a fraction of the declared one")
      ->check(in_range(0.001, 1000.0))
      ->capture_default_str();
  command->add_option("--margin", options.margin_percent, "required slack of the system, %")
      ->capture_default_str();
  command->add_option("--observed", options.observed,
                      "summary.json of a run to compare with the bounds");
  command->add_option("--proof", arguments->proof,
                      "bounds of `glint budget prove --json`, in place of the board's");
  command
      ->add_option("--program", arguments->program,
                   "program that runs; a proof holds only for its machine code")
      ->capture_default_str();
  command->add_flag("--require-proved", options.require_proved,
                    "exit 1 if a kernel's bound is not proved for the program");
  command->add_option("--json", arguments->json, "file of the figures");
  command->footer(
      "Exit code 1: a bound above its deadline, an observation above its bound, a slack\n"
      "below --margin, or with --require-proved an estimated bound.\n"
      "Example: glint budget check --board cortex-a72-emulated --plan plan.toml --clock 0.8");
  command->callback([arguments, &exit_code] { exit_code = run_check(*arguments); });
}

}  // namespace glint
