#include <sys/utsname.h>

#include <algorithm>
#include <ctime>
#include <filesystem>
#include <fstream>

#include "platform/budget/measure/measure_result.hpp"
#include "platform/cells/toml_reader.hpp"
#include "platform/input_error.hpp"

namespace glint {
namespace {

std::string kernel_release() {
  utsname name{};
  return uname(&name) == 0 ? std::string(name.sysname) + " " + name.release : "unknown";
}

std::string governor() {
  std::ifstream in("/sys/devices/system/cpu/cpu0/cpufreq/scaling_governor");
  std::string text;
  return in >> text ? text : "unknown: the kernel shows none";
}

double clock_mhz() {
  std::ifstream in("/proc/cpuinfo");
  for (std::string line; std::getline(in, line);) {
    if (line.starts_with("cpu MHz")) return std::atof(line.c_str() + line.find(':') + 1);
  }
  return 0;
}

std::string today() {
  const std::time_t now = std::time(nullptr);
  std::tm parts{};
  gmtime_r(&now, &parts);
  char text[16];
  std::strftime(text, sizeof text, "%Y-%m-%d", &parts);
  return text;
}

// Costs of a measured kernel; requires that its loops are those of the graph's node.
const std::vector<double>& costs_in(const Measurement& measurement, const KernelLoops& kernel) {
  for (const MeasuredCosts& one : measurement.kernels) {
    if (one.name == kernel.kernel &&
        std::equal(one.loops.begin(), one.loops.end(), kernel.loops.begin(), kernel.loops.end())) {
      return one.cost;
    }
  }
  throw InputError("--write: " + std::string(kernel.kernel) +
                   " was measured with other loops than those of the graph's node; expected a "
                   "measuring program of this version, and all kernels");
}

}  // namespace

Board measured_board(const Measurement& measurement, const BoardRequest& request,
                     const BoardExpectation& expected) {
  Board board;
  board.name = request.name;
  board.build = measurement.build;
  board.graphs = expected.graphs;
  board.counter = measurement.count_instructions ? CostCounter::instructions : CostCounter::time;
  board.ns_per_instruction = measurement.count_instructions ? request.ns_per_instruction : 1;
  BoardProvenance& from = board.provenance;
  from.machine = measurement.machine;
  from.kernel = kernel_release();
  from.governor = measurement.count_instructions ? "none: instructions are counted" : governor();
  from.version = measurement.version;
  from.date = today();
  from.command = request.command;
  from.clock_mhz = measurement.count_instructions ? 0 : clock_mhz();
  from.inputs = request.inputs;
  from.margin_percent = request.margin_percent;
  board.system = request.system;
  std::vector<KernelLoops> kernels = expected.kernels;
  for (const BoardExpectation::Optional& optional : expected.optional) {
    board.graphs.push_back(optional.graph);
    kernels.insert(kernels.end(), optional.kernels.begin(), optional.kernels.end());
  }
  for (const KernelLoops& kernel : kernels) {
    board.kernels.push_back({kernel, costs_in(measurement, kernel)});
  }
  compute_costs(board);
  return board;
}

Board with_kernels(const Board& old, const Measurement& measurement, const BoardRequest& request,
                   const BoardExpectation& expected) {
  const auto require = [&](const std::string& what, const std::string& found,
                           const std::string& wanted) {
    if (found == wanted) return;
    throw InputError("--write: " + old.name + " has " + what + " \"" + wanted +
                     "\", this measurement \"" + found + "\"; expected the same, or all kernels");
  };
  const auto counter = [](bool instructions) { return instructions ? "instructions" : "time"; };
  require("build", measurement.build, old.build);
  require("machine", measurement.machine, old.provenance.machine);
  require("counter", counter(measurement.count_instructions),
          counter(old.counter == CostCounter::instructions));
  require("inputs", std::to_string(request.inputs), std::to_string(old.provenance.inputs));
  require("margin_percent", std::to_string(request.margin_percent),
          std::to_string(old.provenance.margin_percent));
  Board board = old;
  for (BoardKernel& kernel : board.kernels) {
    for (const MeasuredCosts& one : measurement.kernels) {
      if (one.name == kernel.loops.kernel) kernel.cost = costs_in(measurement, kernel.loops);
    }
  }
  for (const BoardExpectation::Optional& optional : expected.optional) {
    const bool known =
        std::any_of(board.graphs.begin(), board.graphs.end(),
                    [&](const GraphName& graph) { return graph.name == optional.graph.name; });
    const bool measured = std::any_of(
        measurement.kernels.begin(), measurement.kernels.end(),
        [&](const MeasuredCosts& one) { return one.name == optional.kernels.front().kernel; });
    if (known || !measured) continue;
    board.graphs.push_back(optional.graph);
    for (const KernelLoops& kernel : optional.kernels) {
      board.kernels.push_back({kernel, costs_in(measurement, kernel)});
    }
  }
  compute_costs(board);
  return board;
}

SystemShare system_share_in(const std::string& file) {
  SystemShare share;
  if (!std::filesystem::exists(file)) return share;
  const toml::table root = parse_toml(read_text(file), file);
  const toml::table* system = root["system"].as_table();
  if (system == nullptr) return share;
  constexpr std::int64_t second = 1'000'000'000;
  TomlReader reader(*system, file, "system.");
  share.wake_up_ns = reader.integer("wake_up_ns", 0, 0, second);
  share.interrupt_ns = reader.integer("interrupt_ns", 0, 0, second);
  share.interrupt_gap_ns = reader.integer("interrupt_gap_ns", 0, 0, second);
  share.can_write_ns = reader.integer("can_write_ns", 0, 0, second);
  share.inter_core_delay_ns = reader.integer("core_handover_ns", 0, 0, second);
  return share;
}

}  // namespace glint
