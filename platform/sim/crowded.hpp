// Scenario with many tools and many stray reflections, for cost curves and robustness.
#pragma once

#include <cstdint>

#include "kernels/pose/tool.hpp"
#include "platform/sim/scenario.hpp"

namespace glint::sim {

inline constexpr int k_strays_max = 200;

// Different tools of five spheres; markers of a tool are at least 28 mm apart. The first n tools
// are the same for every count.
[[nodiscard]] ToolSet crowd_of_tools(int count, std::uint64_t seed);

// Tools side by side at half a metre, a swaying head, and `strays` single spheres in front of the
// far wall. The first n strays are the same for every count.
[[nodiscard]] Scenario crowded_run(const ToolSet& tools, int strays, std::uint64_t seed);

}  // namespace glint::sim
