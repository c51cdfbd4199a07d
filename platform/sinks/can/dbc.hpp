// DBC file of a cell's CAN messages, from the table in kernels/wire/can_messages.hpp.
#pragma once

#include <string>
#include <vector>

#include "kernels/wire/can_messages.hpp"

namespace glint {

struct DbcBus {
  CanAddress address;                     // buttons 0: no button message
  CanFormat format = CanFormat::classic;  // the messages of the other one have no cycle time
  double tick_hz = 250;
  std::vector<std::string> tools;  // names
};

// Prefixes of the tools' messages: "left pen" -> "LeftPen". ASCII letters, digits and at most one
// underscore, at most 17 characters, each different.
[[nodiscard]] std::vector<std::string> dbc_prefixes(const std::vector<std::string>& tools);

// The text is ASCII. Emergencies use extended multiplexing (SG_MUL_VAL_).
[[nodiscard]] std::string dbc_text(const DbcBus& bus);

}  // namespace glint
