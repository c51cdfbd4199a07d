// What a cell's limits mean to a node.
#pragma once

#include <algorithm>

#include "graph/loops.hpp"
#include "graph/port.hpp"
#include "kernels/limits.hpp"
#include "kernels/pose/tool.hpp"

namespace glint {

// Slice i takes the tools whose number leaves i when divided by the slices' count: the first slice
// has the most.
[[nodiscard]] constexpr int tools_of(const Limits& limits, graph::Slice slice) {
  return std::max(0, (limits.tools - slice.index + slice.count - 1) / slice.count);
}

// A tool set may be exchanged at run time; what is beyond the limits is left alone.
[[nodiscard]] inline int tools_within(const ToolSet& set, const Limits& limits) {
  return std::min(set.count, limits.tools);
}
[[nodiscard]] inline int markers_within(const Tool& tool, const Limits& limits) {
  return std::min(tool.marker_count, limits.markers_per_tool);
}

}  // namespace glint
