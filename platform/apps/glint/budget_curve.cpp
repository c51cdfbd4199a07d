// glint budget curve: cost of a frame against the number of tools and false markers, with its
// bound.
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <vector>

#include "platform/apps/glint/budget_commands.hpp"
#include "platform/apps/glint/measure_request.hpp"
#include "platform/apps/glint/output_file.hpp"
#include "platform/apps/glint/progress.hpp"
#include "platform/budget/curve/cost_curve.hpp"
#include "platform/budget/expected_board.hpp"
#include "platform/in_range.hpp"
#include "platform/input_error.hpp"
#include "platform/printable.hpp"

namespace glint {
namespace {

MeasureTarget crowd_target() {
  MeasureTarget target;
  target.program = "glint_measure_crowd";
  return target;
}

struct CurveCommand {
  MeasureTarget target = crowd_target();
  std::string board, json, out;
  std::uint64_t frames = 60;
};

nlohmann::ordered_json as_json(const std::vector<CurveRow>& rows, const Board& board,
                               const std::string& unit) {
  nlohmann::ordered_json points = nlohmann::ordered_json::array();
  for (const CurveRow& row : rows) {
    points.push_back({{"tools", row.point.tools},
                      {"strays", row.point.strays},
                      {"frames", row.frames},
                      {"median", row.median},
                      {"observed_max", row.maximum},
                      {"bound", row.bound}});
  }
  return {
      {"board", board.name}, {"board_sha256", board.sha256}, {"unit", unit}, {"points", points}};
}

int draw_curve(const CurveCommand& command) {
  const Board board = load_board(command.board, expected_board(), BoardUse::analyse);
  const bool counts = command.target.count == "instructions";
  if (counts != (board.counter == CostCounter::instructions)) {
    throw InputError("board " + board.name + " holds costs of another counter; expected --count " +
                     (counts ? "time" : "instructions"));
  }
  MeasureRequest request = measure_request(command.target);
  request.inputs = command.frames;
  Progress progress("measuring");
  const Observations seen = measure(request, [&](int done, int all) { progress.show(done, all); });
  progress.clear();
  const std::vector<CurveRow> rows = cost_curve(seen, board);
  const std::string unit = counts ? "instructions" : "ns";
  std::printf("%s a frame, ROI on, 512x512; bound by board %s\n\n", unit.c_str(),
              printable(board.name).c_str());
  std::printf("%5s %6s %6s %12s %12s %12s\n", "tools", "strays", "frames", "median", "max",
              "bound");
  bool holds = !rows.empty();
  for (const CurveRow& row : rows) {
    std::printf("%5d %6d %6zu %12.0f %12.0f %12.0f%s\n", row.point.tools, row.point.strays,
                row.frames, row.median, row.maximum, row.bound,
                row.holds() ? "" : "  ABOVE ITS BOUND");
    holds = holds && row.holds();
  }
  if (!holds) {
    std::fputs(advice_above_bound(board.counter, board.provenance.command).c_str(), stdout);
  }
  write_json(command.json, as_json(rows, board, unit));
  if (!command.out.empty()) {
    write_text(command.out + "/cost_against_strays.svg", strays_plot(rows, unit));
    write_text(command.out + "/cost_against_tools.svg", tools_plot(rows, unit));
  }
  // Other load on the machine may raise a time above its bound, but not an instruction count.
  return holds || !counts ? 0 : 1;
}

}  // namespace

void add_budget_curve(CLI::App& budget, int& exit_code) {
  CLI::App* command = budget.add_subcommand(
      "curve", "Measure a frame's cost against tools and strays, beside its bound");
  auto arguments = std::make_shared<CurveCommand>();
  command->footer(
      "Example: glint budget curve --board x86-64-emulated --out out --json out/curve.json\n"
      "0 to 200 strays with 5 tools, 1 to 16 tools with 20 strays. Exit code 1: instructions "
      "exceed the bound.");
  command
      ->add_option("--board", arguments->board, "board file or built-in board: costs for the bound")
      ->required();
  command->add_option("--count", arguments->target.count, "counted quantity")
      ->check(CLI::IsMember({"instructions", "time"}))
      ->capture_default_str();
  command->add_option("--arch", arguments->target.arch, "architecture of the measuring program")
      ->check(CLI::IsMember({"x86-64", "arm64"}))
      ->capture_default_str();
  command->add_option("--frames", arguments->frames, "frames at each point")
      ->check(in_range(20, 100'000))
      ->capture_default_str();
  command->add_option("--measure-program", arguments->target.program_file,
                      "path of glint_measure_crowd; default: beside glint");
  command->add_option("--json", arguments->json, "file of the figures");
  command->add_option("--out", arguments->out, "folder of the two plots");
  command->callback([arguments, &exit_code] { exit_code = draw_curve(*arguments); });
}

}  // namespace glint
