// Scenes of the experiment `clutter`: hands with tools among false markers, and similar tools.
#pragma once

#include <cstdint>

#include "kernels/pose/tool.hpp"
#include "platform/sim/scenario.hpp"

namespace glint {

// The built-in pen, NDI 8700339 and STTAR's pointer (both flat), and two tools of five balls each.
[[nodiscard]] ToolSet five_tools(std::uint64_t seed);

// The first tool and its mirror image: all side lengths are equal.
[[nodiscard]] ToolSet mirror_twins(const Tool& tool);

// NDI 8700339 and a copy whose last marker is moved, in steps of 0.1 mm, until the cell reader's
// measure of their distinction exceeds `sigmas`.
[[nodiscard]] ToolSet nearly_equal_tools(double sigmas);

// The tools side by side in moving hands, the head swaying, with `strays` single static balls of a
// marker's size and signal among them. The first n false markers are the same for every n.
[[nodiscard]] sim::Scenario cluttered_run(const ToolSet& tools, int strays, int frames,
                                          std::uint64_t seed);

enum class Passing { beside, occluding };
// Two hands that swing past each other every two seconds, 0.1 m apart: one above the other, or the
// first between camera and second, which it occludes for a while.
[[nodiscard]] sim::Scenario passing_run(const ToolSet& two_tools, Passing passing, int frames,
                                        std::uint64_t seed);

}  // namespace glint
