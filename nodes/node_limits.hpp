// Loop limits of the nodes, derived from the cell's limits.
#pragma once

#include <algorithm>

#include "graph/loops.hpp"
#include "graph/port.hpp"
#include "kernels/limits.hpp"
#include "kernels/pose/tool.hpp"

namespace glint {

// Partition i takes the tools with index modulo n = i, n partitions. The first one has the most.
[[nodiscard]] constexpr int tools_of(const Limits& limits, graph::Partition partition) {
  return std::max(0, (limits.tools - partition.index + partition.count - 1) / partition.count);
}

// A tool set may be replaced at run time; tools and markers beyond the limits are ignored.
[[nodiscard]] inline int tools_within(const ToolSet& set, const Limits& limits) {
  return std::min(set.count, limits.tools);
}
[[nodiscard]] inline int markers_within(const Tool& tool, const Limits& limits) {
  return std::min(tool.marker_count, limits.markers_per_tool);
}

}  // namespace glint
