// Tools for the tests of tool distinction.
#pragma once

#include <algorithm>
#include <initializer_list>
#include <string>

#include "tests/unit/kernels/pose/scene.hpp"

namespace glint::test {

inline Tool random_tool(Random& random, int markers, double side_m) {
  for (;;) {
    Tool tool;
    tool.marker_count = markers;
    for (int i = 0; i < markers; ++i) {
      tool.markers_m[static_cast<std::size_t>(i)] = random.in_box(side_m);
    }
    if (prepare_tool(tool) == Reason::none) return tool;
  }
}

// Applies `where` to each of the tool's markers and reverses their order.
template <class Where>
Tool permuted_tool(const Tool& tool, Where&& where) {
  Tool out = tool;
  for (int i = 0; i < tool.marker_count; ++i) {
    out.markers_m[static_cast<std::size_t>(i)] =
        where(tool.markers_m[static_cast<std::size_t>(tool.marker_count - 1 - i)]);
  }
  if (prepare_tool(out) != Reason::none) out.marker_count = 0;
  return out;
}

inline ToolSet set_of(std::initializer_list<Tool> tools) {
  ToolSet set;
  for (const Tool& tool : tools) {
    Tool& item = set.items[static_cast<std::size_t>(set.count)];
    item = tool;
    item.name = {static_cast<char>('a' + set.count)};
    ++set.count;
  }
  return set;
}

// Five markers: all distances differ by at least 9 mm, no four markers are coplanar.
inline Tool asymmetric_tool() {
  return tool_of({{-2, 23, 232}, {-40, 45, 115}, {45, 45, 240}, {-8, -45, 115}, {22, 24, 129}});
}

}  // namespace glint::test
