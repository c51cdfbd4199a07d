// Reader of tool files: Glint's TOML, and the formats of other manufacturers.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "kernels/pose/tool.hpp"

namespace glint {

// Reads Glint's .toml, NDI's .rom or Atracsys' .ini, selected by the file extension. Returns a
// prepared tool. Throws InputError that names the file, the position and the expectation.
[[nodiscard]] Tool load_tool(const std::string& path);

// Glint's TOML: name, markers_mm = [[x, y, z], ..] (3 to 8), radius_mm, tip_mm = [x, y, z], shape =
// "sphere" (default) or "disc". `path` is for messages only.
[[nodiscard]] Tool tool_from_toml_text(std::string_view text, const std::string& path);

// Returns the built-in pen of platform/cells/tools/pen.toml.
[[nodiscard]] Tool default_pen();

// Returns the built-in static reference body of platform/cells/tools/board.toml.
[[nodiscard]] Tool reference_body();

// Returns the built-in "pen" or "board"; empty for any other name.
[[nodiscard]] std::optional<Tool> built_in_tool(std::string_view name);

// Returns the built-in tool of that name, otherwise load_tool(name).
[[nodiscard]] Tool named_tool(const std::string& name);

}  // namespace glint
