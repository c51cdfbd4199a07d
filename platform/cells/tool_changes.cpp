#include "platform/cells/tool_changes.hpp"

#include <string>

#include "platform/cells/cell.hpp"
#include "platform/cells/toml_reader.hpp"
#include "platform/input_error.hpp"

namespace glint {
namespace {

constexpr double k_longest_run_s = 1e6;

std::string names_of(const ToolSet& tools) {
  std::string names;
  for (int t = 0; t < tools.count; ++t) {
    names +=
        (t > 0 ? ", " : "") + std::string(tools.items[static_cast<std::size_t>(t)].name.data());
  }
  return names;
}

ToolsPresent bit_of(const std::string& name, const Cell& cell, const std::string& place) {
  for (int t = 0; t < cell.tools.count; ++t) {
    if (name == cell.tools.items[static_cast<std::size_t>(t)].name.data())
      return static_cast<ToolsPresent>(1u << t);
  }
  throw InputError(place + ": no tool is named \"" + name +
                   "\"; expected the name of a listed tool: " + names_of(cell.tools));
}

}  // namespace

ToolSet tools_present(const ToolSet& declared, ToolsPresent there) {
  ToolSet set = declared;
  for (int t = 0; t < set.count; ++t) {
    if ((there >> t & 1) == 0) set.items[static_cast<std::size_t>(t)] = Tool{};
  }
  return set;
}

void read_tool_changes(TomlReader& root, Cell& cell) {
  const std::string absent_place = cell.file + ":" + std::to_string(root.line_of("absent"));
  for (const std::string& name : root.texts("absent")) {
    const ToolsPresent bit = bit_of(name, cell, absent_place + ": absent");
    cell.tools_at_start = static_cast<ToolsPresent>(cell.tools_at_start & ~bit);
  }
  ToolsPresent there = cell.tools_at_start;
  Time before;
  for (const toml::table* table : root.tables("tool_change")) {
    TomlReader reader(*table, cell.file, "tool_change");
    const std::string place =
        cell.file + ":" + std::to_string(reader.line_of("at_s")) + ": tool_change";
    const double seconds = reader.real("at_s", 0, 0, k_longest_run_s);
    const Time at{static_cast<std::int64_t>(seconds * 1e9)};
    const std::string added = reader.text("add", ""), removed = reader.text("remove", "");
    reader.done();
    if (at <= before)
      throw InputError(
          place + ": at_s is not later than the previous one; expected increasing times from 0 on");
    if (added.empty() && removed.empty())
      throw InputError(place + " changes nothing; expected add = \"NAME\" or remove = \"NAME\"");
    const ToolsPresent more = added.empty() ? 0 : bit_of(added, cell, place);
    const ToolsPresent less = removed.empty() ? 0 : bit_of(removed, cell, place);
    if ((there & more) != 0 || (there & less) != less)
      throw InputError(place + ": \"" + ((there & more) != 0 ? added : removed) + "\" is " +
                       ((there & more) != 0 ? "already present" : "absent") +
                       "; expected a change at that time");
    there = static_cast<ToolsPresent>((there | more) & ~less);
    cell.tool_changes.push_back({at, there});
    before = at;
  }
}

}  // namespace glint
