// Tools as users write them down, and as other makers' software does.
#pragma once

#include <string>
#include <string_view>

#include "kernels/pose/tool.hpp"

namespace glint {

// Reads Glint's own TOML, NDI's .rom or Atracsys' .ini, told apart by the file's extension. The
// tool is prepared. Throws InputError naming the file, the place in it and what was expected.
[[nodiscard]] Tool load_tool(const std::string& path);

// Glint's TOML: name, markers_mm = [[x, y, z], ..] (3 to 8), radius_mm, tip_mm = [x, y, z],
// shape = "sphere" | "disc" (default "sphere"). `path` stands in messages only.
[[nodiscard]] Tool tool_from_toml_text(std::string_view text, const std::string& path);

}  // namespace glint
