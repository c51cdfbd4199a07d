// A crowd: many tools and many stray reflections at once, for cost curves and robustness.
#pragma once

#include <cstdint>

#include "kernels/pose/tool.hpp"
#include "platform/sim/scenario.hpp"

namespace glint::sim {

inline constexpr int k_strays_max = 200;

// Tools of five balls, no two markers of one tool nearer than 28 mm, all different. The first n
// tools are the same for every n.
[[nodiscard]] ToolSet crowd_of_tools(int count, std::uint64_t seed);

// The tools side by side at half a metre, the head swaying, `strays` single balls in front of the
// far wall. The first n strays are the same for every n.
[[nodiscard]] Scenario crowded_run(const ToolSet& tools, int strays, std::uint64_t seed);

}  // namespace glint::sim
