// Tools as users write them down, and as other makers' software does.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "kernels/pose/tool.hpp"

namespace glint {

// Reads Glint's own .toml, NDI's .rom or Atracsys' .ini, told apart by the file's extension. The
// tool is prepared. Throws InputError naming the file, the place in it and what was expected.
[[nodiscard]] Tool load_tool(const std::string& path);

// Glint's TOML: name, markers_mm = [[x, y, z], ..] (3 to 8), radius_mm, tip_mm = [x, y, z],
// shape = "sphere" (default) or "disc". `path` stands in messages only.
[[nodiscard]] Tool tool_from_toml_text(std::string_view text, const std::string& path);

// The pen of platform/cells/tools/pen.toml, built in.
[[nodiscard]] Tool default_pen();

// The board of platform/cells/tools/board.toml, built in: a reference that does not move.
[[nodiscard]] Tool reference_board();

// "pen" or "board" as they are built in; nothing for any other name.
[[nodiscard]] std::optional<Tool> built_in_tool(std::string_view name);

// The built-in tool of that name, else load_tool(name).
[[nodiscard]] Tool named_tool(const std::string& name);

}  // namespace glint
