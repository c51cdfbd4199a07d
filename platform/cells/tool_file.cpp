#include "platform/cells/tool_file.hpp"

#include <algorithm>
#include <filesystem>

#include "glint_built_in_tools.hpp"
#include "platform/cells/toml_reader.hpp"
#include "platform/cells/tool_formats.hpp"
#include "platform/input_error.hpp"
#include "platform/printable.hpp"

namespace glint {

Tool load_tool(const std::string& path) {
  const std::string ending = std::filesystem::path(path).extension().string();
  if (ending != ".toml" && ending != ".rom" && ending != ".ini") {
    throw InputError(path + ": ends in \"" + ending +
                     "\"; expected a tool file ending in .toml, .rom or .ini");
  }
  if (!std::filesystem::is_regular_file(path)) {
    throw InputError(path + ": is not a file; expected a tool file (.toml, .rom or .ini)");
  }
  const std::string content = read_text(path);
  if (ending == ".rom") return tool_from_rom_bytes(content, path);
  if (ending == ".ini") return tool_from_ini_text(content, path);
  return tool_from_toml_text(content, path);
}

Tool default_pen() { return tool_from_toml_text(k_pen, "built-in pen"); }

Tool reference_body() { return tool_from_toml_text(k_board, "built-in board"); }

std::optional<Tool> built_in_tool(std::string_view name) {
  if (name == "pen") return default_pen();
  if (name == "board") return reference_body();
  return std::nullopt;
}

Tool named_tool(const std::string& name) {
  const std::optional<Tool> built_in = built_in_tool(name);
  return built_in ? *built_in : load_tool(name);
}

std::string stem_of(const std::string& path) { return std::filesystem::path(path).stem().string(); }

void set_name(Tool& tool, const std::string& name, const std::string& place) {
  if (printable(name) != name) {
    throw InputError(place + ": name \"" + name +
                     "\" has unprintable characters; expected printable UTF-8");
  }
  if (name.empty() || name.size() >= tool.name.size()) {
    throw InputError(place + ": name \"" + name + "\" has " + std::to_string(name.size()) +
                     " bytes; expected 1 to " + std::to_string(tool.name.size() - 1));
  }
  tool.name.fill('\0');
  std::copy(name.begin(), name.end(), tool.name.begin());
}

void check_marker_count(long long count, const std::string& place) {
  if (count >= 3 && count <= k_markers_per_tool_max) return;
  throw InputError(place + ": " + std::to_string(count) + " markers; expected 3 to " +
                   std::to_string(k_markers_per_tool_max));
}

Tool prepared(Tool tool, const std::string& place) {
  switch (prepare_tool(tool)) {
    case Reason::none:
      return tool;
    case Reason::collinear:
      throw InputError(place + ": the markers are collinear; expected at least one off the line");
    case Reason::degenerate:
      throw InputError(place + ": two markers coincide; expected at least 1 mm between any two");
    default:
      throw InputError(place + ": the markers determine no pose; expected 3 to 8 distinct points");
  }
}

}  // namespace glint
