// What a cell's limits mean to a node.
#pragma once

#include <algorithm>

#include "graph/loops.hpp"
#include "kernels/limits.hpp"
#include "kernels/pose/tool.hpp"

namespace glint {

// How many copies the tools are spread over; never the worker count.
inline constexpr int k_tool_slices = 4;

// Slice i takes the tools whose number leaves i when divided by k_tool_slices: the first slice has
// the most.
[[nodiscard]] constexpr int tools_per_slice(const Limits& limits) {
  return (limits.tools + k_tool_slices - 1) / k_tool_slices;
}

// A tool set may be exchanged at run time; what is beyond the limits is left alone.
[[nodiscard]] inline int tools_within(const ToolSet& set, const Limits& limits) {
  return std::min(set.count, limits.tools);
}
[[nodiscard]] inline int markers_within(const Tool& tool, const Limits& limits) {
  return std::min(tool.marker_count, limits.markers_per_tool);
}

}  // namespace glint
