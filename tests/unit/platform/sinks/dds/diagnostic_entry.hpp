// One entry of a diagnostics message, with its values by key.
#pragma once

#include <map>
#include <string>

#include "platform/sinks/dds/messages.hpp"

namespace glint {

struct DiagnosticEntry {
  int level = -1;  // -1: the message has no such entry
  std::string message;
  std::map<std::string, std::string> values;
};

inline DiagnosticEntry entry_of(const DiagnosticsMessage& message, const std::string& name) {
  DiagnosticEntry found;
  for (std::uint32_t i = 0; i < message.status._length; ++i) {
    const auto& entry = message.status._buffer[i];
    if (entry.name != name) continue;
    found = {entry.level, entry.message, {}};
    for (std::uint32_t v = 0; v < entry.values._length; ++v) {
      found.values[entry.values._buffer[v].key] = entry.values._buffer[v].value;
    }
  }
  return found;
}

}  // namespace glint
