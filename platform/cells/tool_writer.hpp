// Writer of a tool as a TOML file that load_tool reads.
#pragma once

#include <string>
#include <string_view>

#include "kernels/pose/tool.hpp"

namespace glint {

// Writes numbers to 0.1 um, and each line of `comment` after a # at the top.
[[nodiscard]] std::string tool_toml_text(const Tool& tool, std::string_view comment);

// Returns the tool's name; other characters than letters, digits, - and _ become _.
[[nodiscard]] std::string file_name_of(const Tool& tool);

}  // namespace glint
