// One measurement as a board file and as figures.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "platform/budget/measure/cost_fit.hpp"

namespace glint {

// How often a kernel's median grew beside an enemy.
struct InterferenceFactor {
  std::string enemy, kernel;
  double factor = 1;
};

struct Measurement {
  std::string arch, cache, version, machine, build;
  std::string board;  // whose costs are judged; empty: they are fitted now
  bool count_instructions = true;
  std::vector<MeasuredCosts> kernels;
  std::vector<InterferenceFactor> interference;

  [[nodiscard]] const char* unit() const { return count_instructions ? "instructions" : "ns"; }
};

[[nodiscard]] nlohmann::ordered_json measurement_json(const Measurement& measurement);

struct BoardRequest {
  std::string name, command;
  double ns_per_instruction = 1;
  double margin_percent = 5;
  std::int64_t inputs = 0;
  SystemShare system;  // as it was; it is measured elsewhere
};

// Throws InputError where a kernel of the graphs was not measured.
[[nodiscard]] Board measured_board(const Measurement& measurement, const BoardRequest& request,
                                   const BoardExpectation& expected);

// A board with these kernels' costs in place of its own, all others as they are; kernels of a graph
// that it did not price come with their graph. Throws InputError where the measurement is not of
// the same build, machine and kind as the board's.
[[nodiscard]] Board with_kernels(const Board& old, const Measurement& measurement,
                                 const BoardRequest& request, const BoardExpectation& expected);

// The [system] of a board file that is about to be replaced; nothing where there is none.
[[nodiscard]] SystemShare system_share_in(const std::string& file);

}  // namespace glint
