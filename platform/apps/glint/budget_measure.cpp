// glint budget measure: costs of each kernel's loops, and validation of the bound made of them.
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>

#include "glint_build_signature.hpp"
#include "platform/apps/glint/budget_commands.hpp"
#include "platform/apps/glint/measure_request.hpp"
#include "platform/apps/glint/output_file.hpp"
#include "platform/apps/glint/progress.hpp"
#include "platform/apps/glint/shard_option.hpp"
#include "platform/budget/expected_board.hpp"
#include "platform/budget/measure/measure_result.hpp"
#include "platform/in_range.hpp"
#include "platform/input_error.hpp"
#include "platform/printable.hpp"
#include "platform/runtime/rt/processor_name.hpp"

namespace glint {
namespace {

struct MeasureCommand {
  std::string count = "instructions", arch, kernel, board, write, cache = "warm", json, program;
  std::vector<std::string> loads;
  std::uint64_t inputs = 10'000;
  double margin_percent = 5, ns_per_instruction = 1;
  int jobs = 0, passes = 1;
  Pieces piece;
};

MeasureRequest request_of(const MeasureCommand& command) {
  MeasureRequest request = measure_request(
      {"glint_measure", command.program, command.count, command.arch, command.jobs});
  request.kernel = command.kernel;
  request.cache = command.cache;
  request.inputs = command.inputs;
  request.piece = command.piece;
  return request;
}

std::string machine_of(const MeasureRequest& request) {
  if (request.count_instructions) return request.emulator + " -cpu " + request.cpu_model;
  return processor_name() + ", its time-stamp counter, core 0";
}

Observations observe(const MeasureRequest& request, const std::string& what) {
  Progress progress(what);
  return measure(request, [&](int done, int all) { progress.show(done, all); });
}

Observations observe_in_passes(const MeasureRequest& request, int passes) {
  const std::string what =
      request.load == "none" ? "measuring" : "measuring beside " + request.load;
  Observations seen = observe(request, what);
  for (int pass = 2; pass <= passes; ++pass) {
    const std::string which = ", pass " + std::to_string(pass) + " of " + std::to_string(passes);
    keep_minimum(seen, observe(request, what + which));
  }
  return seen;
}

double median_of(const KernelObservations& kernel) {
  std::vector<double> costs;
  for (const Observation& seen : kernel.calls) costs.push_back(seen.call.cost);
  std::sort(costs.begin(), costs.end());
  return quantile(costs, 0.5);
}

std::vector<InterferenceFactor> interference_of(MeasureRequest request, const Observations& alone,
                                                const MeasureCommand& command) {
  std::vector<InterferenceFactor> factors;
  for (const std::string& load : command.loads) {
    if (load == "none") continue;
    request.load = load;
    const Observations beside = observe_in_passes(request, command.passes);
    for (std::size_t i = 0; i < alone.kernels.size(); ++i) {
      const double before = median_of(alone.kernels[i]);
      const double after = median_of(beside.kernels[i]);
      factors.push_back({load, alone.kernels[i].name, before > 0 ? after / before : 1});
    }
  }
  return factors;
}

const char* verdict_of(const MeasuredCosts& kernel) {
  if (kernel.beyond_declared > 0) return "  A LOOP RAN MORE OFTEN THAN DECLARED";
  return kernel.holds() ? "" : "  ABOVE ITS BOUND";
}

void print(const Measurement& measurement) {
  std::printf("%s a call, %s, %s\n\n", measurement.unit(), printable(measurement.machine).c_str(),
              measurement.board.empty() ? "costs fitted now"
                                        : printable("costs of board " + measurement.board).c_str());
  std::printf("%-15s %12s %12s %6s %6s  %-16s %s\n", "kernel", "bound", "observed max", "ratio",
              "cell", "worst input", "validation half above (worst excess)");
  for (const MeasuredCosts& kernel : measurement.kernels) {
    const std::string worst = std::string(name_of(kernel.worst_input.kind)) + " " +
                              std::to_string(kernel.worst_input.number);
    std::printf("%-15s %12.0f %12.0f %6.3f %6.3f  %-16s %lld of %lld (%.2f %%)%s\n",
                kernel.name.c_str(), kernel.at[0].bound, kernel.at[0].observed_max,
                kernel.at[0].ratio(), kernel.at[1].ratio(), worst.c_str(),
                static_cast<long long>(kernel.judge_half.above),
                static_cast<long long>(kernel.judge_half.calls),
                kernel.judge_half.worst_excess_percent, verdict_of(kernel));
  }
  std::printf("\n%-15s %-18s %12s %12s %12s\n", "kernel", "loop", "declared", "observed",
              "cost a count");
  for (const MeasuredCosts& kernel : measurement.kernels) {
    for (std::size_t j = 0; j < kernel.loops.size(); ++j) {
      std::printf("%-15s %-18s %12lld %12lld %12.3f\n", j == 0 ? kernel.name.c_str() : "",
                  kernel.loops[j].c_str(), static_cast<long long>(kernel.declared[j]),
                  static_cast<long long>(kernel.observed[j]), kernel.cost[j]);
    }
  }
  for (const InterferenceFactor& one : measurement.interference) {
    std::printf("beside %-10s %-15s x %.2f\n", one.load.c_str(), one.kernel.c_str(), one.factor);
  }
}

// Returns the command that makes the same file again, without this machine's paths.
std::string command_text(const MeasureCommand& command) {
  std::string text = "glint budget measure --count " + command.count + " --arch " + command.arch +
                     " --inputs " + std::to_string(command.inputs);
  if (command.passes > 1) text += " --passes " + std::to_string(command.passes);
  return command.cache == "warm" ? text : text + " --cache " + command.cache;
}

void write_board(const MeasureCommand& command, const Measurement& measurement) {
  BoardRequest request;
  request.name = std::filesystem::path(command.write).stem().string();
  request.command = command_text(command);
  request.ns_per_instruction = command.ns_per_instruction;
  request.margin_percent = command.margin_percent;
  request.inputs = static_cast<std::int64_t>(command.inputs);
  request.system = system_share_in(command.write);
  const BoardExpectation expected = expected_board();
  const Board board =
      command.kernel.empty()
          ? measured_board(measurement, request, expected)
          : with_kernels(load_board(std::filesystem::absolute(command.write).string(), expected,
                                    BoardUse::analyse),
                         measurement, request, expected);
  write_text(command.write, board_text(board));
  std::printf("\nwritten  %s\n", command.write.c_str());
}

int measure_costs(const MeasureCommand& command) {
  const MeasureRequest request = request_of(command);
  if (!command.write.empty() && !command.board.empty()) {
    throw InputError(
        "--write stores the measured costs in a board file; expected it without --board");
  }
  if (request.count_instructions && !command.loads.empty()) {
    throw InputError(
        "--interference changes time, not instructions; expected it with --count time");
  }
  if (request.count_instructions && command.passes > 1) {
    throw InputError("--passes: instruction counts repeat exactly; expected it with --count time");
  }
  if (!request.count_instructions && command.piece.work->is_shard()) {
    throw InputError(
        "--shard: times of other machines or moments do not repeat; expected "
        "--count instructions");
  }
  const BoardExpectation expected = expected_board();
  Board board;
  if (!command.board.empty()) board = load_board(command.board, expected, BoardUse::analyse);
  const CostCounter counter =
      request.count_instructions ? CostCounter::instructions : CostCounter::time;
  if (!command.board.empty() && board.counter != counter) {
    throw InputError("board " + board.name + " holds costs of another counter; expected --count " +
                     (request.count_instructions ? "time" : "instructions"));
  }

  const Observations seen = observe_in_passes(request, command.passes);
  if (command.piece.work->finish()) return 0;
  Measurement measurement;
  measurement.arch = command.arch;
  measurement.cache = command.cache;
  measurement.version = k_version;
  measurement.machine = machine_of(request);
  measurement.build = seen.build;
  measurement.board = board.name;
  measurement.count_instructions = request.count_instructions;
  for (const KernelObservations& kernel : seen.kernels) {
    const BoardKernel* costs = nullptr;
    for (const BoardKernel& one : board.kernels) {
      if (one.loops.kernel == kernel.name) costs = &one;
    }
    if (!command.board.empty() && costs == nullptr) continue;  // belongs to no graph that runs
    measurement.kernels.push_back(costs_of(kernel, costs, command.margin_percent / 100));
  }
  measurement.interference = interference_of(request, seen, command);
  print(measurement);
  write_json(command.json, measurement_json(measurement));
  bool holds = true;
  for (const MeasuredCosts& kernel : measurement.kernels) holds = holds && kernel.holds();
  if (!holds) {
    const std::string made_by =
        command.board.empty() ? command_text(command) : board.provenance.command;
    std::fputs(advice_above_bound(counter, made_by).c_str(), stdout);
  }
  if (!command.write.empty() && holds) write_board(command, measurement);
  return holds ? 0 : 1;
}

}  // namespace

void add_budget_measure(CLI::App& budget, int& exit_code, ShardedWork& work) {
  CLI::App* command = budget.add_subcommand(
      "measure", "Measure the cost of each kernel's loops, and validate the bound from it");
  auto arguments = std::make_shared<MeasureCommand>();
  arguments->arch = k_own_arch;
  arguments->piece = {&work};
  command->footer(
      "Example: glint budget measure --count instructions --arch arm64 --json measure.json\n"
      "Costs are an upper envelope of one half of the inputs with a margin, validated on the "
      "other\n"
      "half. With --board the bound is that board's. Exit code 1: a call costs more than its "
      "bound.\n"
      "An emulator (Debian package qemu-user) counts instructions; the counts repeat exactly.");
  command->add_option("--count", arguments->count, "counted quantity")
      ->check(CLI::IsMember({"instructions", "time"}))
      ->capture_default_str();
  command->add_option("--arch", arguments->arch, "architecture of the measuring program")
      ->check(CLI::IsMember({"x86-64", "arm64"}))
      ->capture_default_str();
  command->add_option("--inputs", arguments->inputs, "inputs of each kernel")
      ->check(in_range(20, 10'000'000))
      ->capture_default_str();
  command->add_option("--kernel", arguments->kernel, "one kernel only");
  command->add_option("--board", arguments->board, "board whose costs are validated; no fit");
  command->add_option("--write", arguments->write,
                      "board file to write; with --kernel: board file to update");
  command->add_option("--margin", arguments->margin_percent, "margin added to the fitted costs, %")
      ->check(in_range(0.0, 100.0))
      ->capture_default_str();
  command
      ->add_option("--ns-per-instruction", arguments->ns_per_instruction,
                   "time of an instruction, declared in the board file")
      ->check(in_range(0.001, 1000.0))
      ->capture_default_str();
  command->add_option("--cache", arguments->cache, "warm, or cold: evicted before each call")
      ->check(CLI::IsMember({"warm", "cold"}))
      ->capture_default_str();
  command
      ->add_option("--passes", arguments->passes,
                   "passes over all inputs; each input counts with its least time")
      ->check(in_range(1, 100))
      ->capture_default_str();
  command
      ->add_option("--interference,--enemy", arguments->loads,
                   "load that runs beside a further measurement")
      ->check(CLI::IsMember({"none", "cache", "bandwidth", "other_core", "interrupts"}));
  command->add_option("--jobs", arguments->jobs, "kernels counted in parallel; 0: one a core")
      ->check(in_range(0, 256));
  command->add_option("--measure-program", arguments->program,
                      "path of glint_measure; default: beside glint");
  command->add_option("--json", arguments->json, "file of the figures");
  add_shard_option(*command, work);
  command->callback([arguments, &exit_code] { exit_code = measure_costs(*arguments); });
}

}  // namespace glint
