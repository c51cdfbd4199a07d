// Certificate of an upper bound of the longest path: whole multipliers of loop maxima, potentials
// of blocks and values of functions, by weak duality.
//
// A path's cost is a sum over its edges. If every edge's cost is at most the fall of the potential
// along it plus its share of the multipliers, no path costs more than the root's value plus
// multipliers times totals. All numbers are integers; a checker needs additions and comparisons
// only: tests/unit/platform/budget/prove/check_certificate.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "platform/budget/prove/path_graph.hpp"
#include "platform/budget/prove/path_solver.hpp"

namespace glint::prove {

struct Certificate {
  std::int64_t bound = 0;  // instructions of the kernel's call
  std::vector<std::int64_t> blocks, functions, loops, totals;
};

// From the solver's multipliers of the totals, rounded up to integers where they are none. Each
// loop's smallest multiplier follows from them, inside out. Throws std::runtime_error if a cycle
// has no maximum.
[[nodiscard]] Certificate certificate_of(const PathGraph& graph, const PathSolution& solution);

[[nodiscard]] std::string text_of(const Certificate& certificate, const std::string& graph_sha256);

}  // namespace glint::prove
