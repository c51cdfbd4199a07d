#include "platform/cells/cell_can.hpp"

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <string>
#include <vector>

#include "kernels/wire/can_frames.hpp"
#include "kernels/wire/can_messages.hpp"
#include "platform/input_error.hpp"

namespace glint {
namespace {

std::string hexadecimal(std::uint32_t identifier) {
  char text[16];
  std::snprintf(text, sizeof text, "0x%X", identifier);
  return text;
}

[[noreturn]] void refuse(const TomlReader& reader, const Cell& cell, const char* key,
                         const std::string& what) {
  throw InputError(cell.file + ":" + std::to_string(reader.line_of(key)) + ": can." + key + what);
}

CanAddress address_of(const CanSettings& can) {
  return {can.base_id, static_cast<std::uint32_t>(can.node)};
}

std::vector<std::uint32_t> node_identifiers(const CanAddress& address) {
  std::vector<std::uint32_t> identifiers;
  for (const CanMessageLayout& message : k_can_messages) {
    if (message.rule == CanIdentifierRule::of_node)
      identifiers.push_back(identifier_of(message, address));
  }
  return identifiers;
}

// First and last identifier of the tools.
std::string tool_range(const Cell& cell) {
  const std::uint32_t base = cell.can.base_id;
  const auto tools = static_cast<std::uint32_t>(cell.tools.count);
  return hexadecimal(base) + " to " + hexadecimal(base + tools * k_can_tool_stride - 1);
}

// A message of the node must not have an identifier of a tool's.
void check_base(const TomlReader& reader, const Cell& cell) {
  const CanAddress address = address_of(cell.can);
  for (const std::uint32_t identifier : node_identifiers(address)) {
    if (!is_tool_can_identifier(identifier, address, cell.tools.count)) continue;
    refuse(reader, cell, "base_id",
           " is " + hexadecimal(address.base) + ": the tools' identifiers " + tool_range(cell) +
               " contain " + hexadecimal(identifier) + " of can.node " +
               std::to_string(address.node) + "; expected another base_id or node");
  }
}

void read_buttons(TomlReader& reader, Cell& cell) {
  const auto identifier =
      static_cast<std::uint32_t>(reader.integer("buttons", 0, 1, k_can_identifier_max));
  if (identifier == 0) return;
  const CanAddress address = address_of(cell.can);
  const std::vector<std::uint32_t> of_node = node_identifiers(address);
  if (is_tool_can_identifier(identifier, address, cell.tools.count) ||
      std::ranges::find(of_node, identifier) != of_node.end()) {
    std::string expected = tool_range(cell);
    for (const std::uint32_t other : of_node) expected += ", " + hexadecimal(other);
    refuse(reader, cell, "buttons",
           " is " + hexadecimal(identifier) +
               ", an identifier that Glint sends; expected none of " + expected);
  }
  cell.can.buttons = identifier;
}

}  // namespace

void read_can(const toml::table* table, Cell& cell) {
  if (table == nullptr) return;
  TomlReader reader(*table, cell.file, "can.");
  CanSettings& can = cell.can;
  can.sink = reader.text("sink", can.sink);
  can.format =
      can_format_of(reader.one_of("frames", "classic", {"classic", "fd", "fd_covariance"}));
  can.base_id =
      static_cast<std::uint32_t>(reader.integer("base_id", k_can_base_default, 1, k_can_base_max));
  can.bit_rate = reader.integer("bit_rate", can.bit_rate, 10'000, 1'000'000);
  can.data_bit_rate = reader.integer("data_bit_rate", can.data_bit_rate, 10'000, 8'000'000);
  can.node = static_cast<int>(reader.integer("node", can.node, 1, 127));
  check_base(reader, cell);
  read_buttons(reader, cell);
  reader.done();
}

}  // namespace glint
