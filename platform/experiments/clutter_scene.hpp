// What the experiment `clutter` looks at: hands with tools among strays, and tools that are alike.
#pragma once

#include <cstdint>

#include "kernels/pose/tool.hpp"
#include "platform/sim/scenario.hpp"

namespace glint {

// The built-in pen, NDI 8700339 and STTAR's pointer, which are flat, and two of five balls each.
[[nodiscard]] ToolSet five_tools(std::uint64_t seed);

// The first tool beside its mirror image: equal in every side.
[[nodiscard]] ToolSet mirror_twins(const Tool& tool);

// NDI 8700339 and one like it, whose last marker is moved until the cell reader's measure says that
// the two are more than `sigmas` apart, by a tenth of a millimetre at most.
[[nodiscard]] ToolSet nearly_equal_tools(double sigmas);

// The tools side by side in moving hands, the head swaying, `strays` single balls of a marker's
// size and brightness standing anywhere among them. The first n strays are the same for every n.
[[nodiscard]] sim::Scenario cluttered_run(const ToolSet& tools, int strays, int frames,
                                          std::uint64_t seed);

enum class Passing { beside, in_front };
// Two hands that swing past each other every two seconds, 0.1 m apart: one above the other, or the
// first between the camera and the second, which it hides for a while.
[[nodiscard]] sim::Scenario passing_run(const ToolSet& two_tools, Passing passing, int frames,
                                        std::uint64_t seed);

}  // namespace glint
