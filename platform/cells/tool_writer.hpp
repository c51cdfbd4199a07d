// A tool as the TOML file that load_tool reads back.
#pragma once

#include <string>
#include <string_view>

#include "kernels/pose/tool.hpp"

namespace glint {

// Numbers to a tenth of a micrometre; every line of `comment` stands behind a # above.
[[nodiscard]] std::string tool_toml_text(const Tool& tool, std::string_view comment);

// Its name with every character but letters, digits, - and _ replaced by _.
[[nodiscard]] std::string file_name_of(const Tool& tool);

}  // namespace glint
