// The longest-path problem as an integer linear program, and its solution by `cbc`.
//
// The continuous problem is solved: its optimum is a bound of the integer one, and where every
// value of its solution is whole, both are equal. cbc's numbers are never trusted: they only state
// which multipliers a certificate tries (certificate.hpp).
#pragma once

#include <string>
#include <vector>

#include "platform/budget/prove/path_graph.hpp"

namespace glint::prove {

struct PathSolution {
  double longest = 0;          // cbc's objective
  bool whole = false;          // all values are whole: a solution of the integer program
  std::vector<double> runs;    // executions of each block on a longest path
  std::vector<double> totals;  // multiplier of each total
};

// The problem in the text form that cbc reads.
[[nodiscard]] std::string program_text(const PathGraph& graph);

// Runs cbc in `folder`, which it fills with path.lp and path.sol. Throws MissingDevice if there is
// no cbc, and std::runtime_error if it finds no optimum.
[[nodiscard]] PathSolution solve(const PathGraph& graph, const std::string& folder);

}  // namespace glint::prove
