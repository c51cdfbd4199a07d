// Result of one measurement, converted to a board file and to JSON.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "platform/budget/measure/cost_fit.hpp"

namespace glint {

// Growth factor of a kernel's median beside an interference workload.
struct InterferenceFactor {
  std::string load, kernel;
  double factor = 1;
};

struct Measurement {
  std::string arch, cache, version, machine, build;
  std::string board;  // board whose costs are judged; empty: costs are fitted
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
  SystemShare system;  // unchanged; measured separately
};

// Throws InputError if a kernel of the graphs was not measured.
[[nodiscard]] Board measured_board(const Measurement& measurement, const BoardRequest& request,
                                   const BoardExpectation& expected);

// Replaces the measured kernels' costs in `old`; keeps all others. Adds kernels of a graph that
// `old` lacks together with that graph. Throws InputError if the measurement differs in build,
// machine or kind from the board's.
[[nodiscard]] Board with_kernels(const Board& old, const Measurement& measurement,
                                 const BoardRequest& request, const BoardExpectation& expected);

// The [system] of a board file that will be replaced; all zero if there is none.
[[nodiscard]] SystemShare system_share_in(const std::string& file);

}  // namespace glint
