// Board file with the same cost for every loop, and a small problem for it.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "platform/budget/expected_board.hpp"

namespace glint {

// Every loop of every kernel costs `ns_a_count`.
inline Board uniform_costs(double ns_a_count) {
  Board board;
  board.name = "flat";
  board.sha256 = std::string(64, '0');
  const auto add = [&](const KernelLoops& loops) {
    board.kernels.push_back({loops, std::vector<double>(loops.loops.size(), ns_a_count)});
  };
  const BoardExpectation expected = expected_board();
  std::for_each(expected.kernels.begin(), expected.kernels.end(), add);
  for (const BoardExpectation::Optional& optional : expected.optional) {
    std::for_each(optional.kernels.begin(), optional.kernels.end(), add);
  }
  compute_costs(board);
  board.system = {20'000, 2'000, 1'000'000, 5'000, 500};
  return board;
}

inline Limits small_limits() {
  Limits limits;
  limits.tools = 1;
  limits.blobs = 16;
  limits.markers_per_tool = 4;
  return limits;
}

}  // namespace glint
