#include "platform/cells/cell_can.hpp"

#include <cstdio>
#include <string>

#include "kernels/wire/can_frames.hpp"
#include "platform/input_error.hpp"

namespace glint {
namespace {

// CiA 301: emergencies and heartbeats of a node.
constexpr std::uint32_t k_emergencies = 0x80;
constexpr std::uint32_t k_heartbeats = 0x700;

std::string hexadecimal(std::uint32_t identifier) {
  char text[16];
  std::snprintf(text, sizeof text, "0x%X", identifier);
  return text;
}

void read_buttons(TomlReader& reader, Cell& cell) {
  const auto identifier =
      static_cast<std::uint32_t>(reader.integer("buttons", 0, 1, k_can_identifier_max));
  if (identifier == 0) return;
  const CanSettings& can = cell.can;
  const auto node = static_cast<std::uint32_t>(can.node);
  const std::uint32_t last =
      can.base_id + static_cast<std::uint32_t>(cell.tools.count) * k_can_tool_stride - 1;
  if ((identifier >= can.base_id && identifier <= last) || identifier == k_emergencies + node ||
      identifier == k_heartbeats + node) {
    throw InputError(
        cell.file + ":" + std::to_string(reader.line_of("buttons")) + ": can.buttons is " +
        hexadecimal(identifier) + ", an identifier that Glint sends; expected none of " +
        hexadecimal(can.base_id) + " to " + hexadecimal(last) + ", " +
        hexadecimal(k_emergencies + node) + " and " + hexadecimal(k_heartbeats + node));
  }
  cell.can.buttons = identifier;
}

}  // namespace

void read_can(const toml::table* table, Cell& cell) {
  if (table == nullptr) return;
  TomlReader reader(*table, cell.file, "can.");
  CanSettings& can = cell.can;
  can.sink = reader.text("sink", can.sink);
  can.fd = reader.one_of("frames", "classic", {"classic", "fd"}) == "fd";
  can.base_id =
      static_cast<std::uint32_t>(reader.integer("base_id", k_can_base_default, 1, k_can_base_max));
  can.bit_rate = reader.integer("bit_rate", can.bit_rate, 10'000, 1'000'000);
  can.data_bit_rate = reader.integer("data_bit_rate", can.data_bit_rate, 10'000, 8'000'000);
  can.node = static_cast<int>(reader.integer("node", can.node, 1, 127));
  read_buttons(reader, cell);
  reader.done();
}

}  // namespace glint
