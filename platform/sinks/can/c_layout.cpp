#include "platform/sinks/can/c_layout.hpp"

#include <algorithm>
#include <cstdio>
#include <set>
#include <string_view>

#include "kernels/wire/can_messages.hpp"

namespace glint {
namespace {

bool is_upper(char c) { return c >= 'A' && c <= 'Z'; }

// "SigmaPosition" -> "SIGMA_POSITION"
std::string macro_word(std::string_view name) {
  std::string word;
  for (std::size_t i = 0; i < name.size(); ++i) {
    if (i > 0 && is_upper(name[i]) && !is_upper(name[i - 1])) word += '_';
    const bool lower = name[i] >= 'a' && name[i] <= 'z';
    word += lower ? static_cast<char>(name[i] - 'a' + 'A') : name[i];
  }
  return word;
}

void add_define(std::string& text, const std::string& name, const std::string& value) {
  text += "#define GLINT_" + name + " " + value + "\n";
}

void add_signal(std::string& text, const std::string& message, const CanSignal& signal) {
  const std::string name = message + "_" + macro_word(signal.name);
  add_define(text, name,
             std::to_string(signal.field.first_bit()) + ", " + std::to_string(signal.field.width));
  if (signal.step == 1) return;
  char step[64];
  std::snprintf(step, sizeof step, "%.15g", signal.step / signal.unit.in_si);
  const std::string unit(signal.unit.name);
  add_define(text, name + "_STEP", unit.empty() ? step : step + (" /* " + unit + " */"));
}

}  // namespace

std::string c_layout_text() {
  std::string text =
      "/* Layout of a tool's CAN messages, written by `glint can c-layout`. An identifier is that "
      "of\n"
      " * the tool's first message + offset; of the heartbeat: the node's number + offset. A "
      "signal:\n"
      " * first bit (Intel order), width in bits. */\n"
      "#ifndef GLINT_CAN_LAYOUT_H\n#define GLINT_CAN_LAYOUT_H\n\n";
  add_define(text, "TOOL_STRIDE", std::to_string(k_can_tool_stride));
  std::set<std::string> named;
  std::string names;
  for (const CanMessageLayout& layout : k_can_messages) {
    const bool of_tool = layout.rule == CanIdentifierRule::of_tool;
    if (!of_tool && layout.name != "Heartbeat") continue;
    const std::string message = macro_word(layout.name);
    text += '\n';
    add_define(text, message + "_OFFSET", std::to_string(layout.offset));
    add_define(text, message + "_BYTES", std::to_string(layout.bytes));
    for (const CanSignal& signal : layout.signals) {
      add_signal(text, message, signal);
      const std::string word = macro_word(signal.name);
      if (signal.names.empty() || !named.insert(word).second) continue;
      for (const CanValueName& name : signal.names)
        add_define(names, word + "_" + macro_word(name.name), std::to_string(name.value));
    }
  }
  return text + "\n" + names + "\n#endif\n";
}

}  // namespace glint
