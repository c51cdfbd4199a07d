// Tools as users write them down, and as other makers' software does.
#pragma once

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

}  // namespace glint
