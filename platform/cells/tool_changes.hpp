// Active tools of a cell over time. All tools are declared under `tools`, so that results computed
// before a run (bounds, names, distinction of tools) hold for every subset. An absent tool leaves
// its slot empty.
#pragma once

#include <cstdint>
#include <vector>

#include "kernels/pose/tool.hpp"
#include "kernels/units.hpp"

namespace glint {

class TomlReader;
struct Cell;

// Bit t: tool t is present.
using ToolsPresent = std::uint16_t;
static_assert(k_tools_max <= 16);
inline constexpr ToolsPresent k_all_tools = 0xFFFF;

// The set of present tools from `at` on.
struct ToolChange {
  Time at;
  ToolsPresent present = k_all_tools;
};

// Returns the set with empty slots for absent tools.
[[nodiscard]] ToolSet tools_present(const ToolSet& declared, ToolsPresent there);

// Reads absent = ["NAME", ..] and [[tool_change]] at_s, add, remove. Throws InputError: an unknown
// name, times that do not rise, a change without effect.
void read_tool_changes(TomlReader& root, Cell& cell);

}  // namespace glint
