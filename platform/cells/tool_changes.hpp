// Which of a cell's tools are there, and when that changes. All that may ever be there are listed
// under `tools`, so that what is computed before a run (bounds, names, how well tools are told
// apart) holds whichever are; one that is not there leaves its place empty.
#pragma once

#include <cstdint>
#include <vector>

#include "kernels/pose/tool.hpp"
#include "kernels/units.hpp"

namespace glint {

class TomlReader;
struct Cell;

// Bit t: tool t is there.
using ToolsPresent = std::uint16_t;
static_assert(k_tools_max <= 16);
inline constexpr ToolsPresent k_all_tools = 0xFFFF;

// From `at` on `now_there` are there, and no others.
struct ToolChange {
  Time at;
  ToolsPresent now_there = k_all_tools;
};

// The set with the places of those that are not there empty.
[[nodiscard]] ToolSet tools_present(const ToolSet& declared, ToolsPresent there);

// absent = ["NAME", ..] and [[tool_change]] at_s, add, remove. Throws InputError: an unknown name,
// times that do not rise, a change that changes nothing.
void read_tool_changes(TomlReader& root, Cell& cell);

}  // namespace glint
