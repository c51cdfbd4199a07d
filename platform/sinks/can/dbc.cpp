#include "platform/sinks/can/dbc.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <string_view>

namespace glint {
namespace {

constexpr std::size_t k_prefix_max = 14;  // with "_15" and "AngularVelocity": 32, a DBC name's most
constexpr const char* k_nodes[] = {"Glint", "Controller"};

constexpr const char* k_attributes =
    "BA_DEF_ BO_ \"VFrameFormat\" ENUM \"StandardCAN\",\"ExtendedCAN\",\"reserved\",\"reserved\","
    "\"reserved\",\"reserved\",\"reserved\",\"reserved\",\"reserved\",\"reserved\",\"reserved\","
    "\"reserved\",\"reserved\",\"reserved\",\"StandardCAN_FD\",\"ExtendedCAN_FD\";\n"
    "BA_DEF_ BO_ \"CANFD_BRS\" ENUM \"0\",\"1\";\n"
    "BA_DEF_ BO_ \"GenMsgCycleTime\" INT 0 65535;\n"
    "BA_DEF_ \"BusType\" STRING;\n"
    "BA_DEF_DEF_ \"VFrameFormat\" \"StandardCAN\";\n"
    "BA_DEF_DEF_ \"CANFD_BRS\" \"0\";\n"
    "BA_DEF_DEF_ \"GenMsgCycleTime\" 0;\n"
    "BA_DEF_DEF_ \"BusType\" \"CAN\";\n"
    "BA_ \"BusType\" \"CAN FD\";\n";
constexpr int k_standard_can_fd = 14;  // index in VFrameFormat

bool is_lower(char c) { return c >= 'a' && c <= 'z'; }
bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_word(char c) { return is_lower(c) || is_digit(c) || (c >= 'A' && c <= 'Z'); }

std::string prefix_of(std::string_view tool) {
  std::string prefix;
  bool begins_word = true;
  for (const char c : tool) {
    if (is_word(c)) prefix += begins_word && is_lower(c) ? static_cast<char>(c - 'a' + 'A') : c;
    begins_word = !is_word(c);
  }
  if (prefix.empty() || is_digit(prefix[0])) prefix = "Tool" + prefix;
  return prefix.substr(0, k_prefix_max);
}

// A quoted text of a DBC file.
std::string dbc_string(std::string_view text) {
  std::string result = "\"";
  for (const char c : text) {
    const bool plain = c >= ' ' && c <= '~' && c != '\\' && c != '"';
    result += plain ? c : '?';
  }
  return result + '"';
}

std::string number_text(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.15g", value);
  return text;
}

// A message of the table as one tool, or the node, sends it.
struct DbcMessage {
  const CanMessageLayout& layout;
  std::uint32_t identifier = 0;
  std::string name;
  std::string tool;  // its name, empty for the node's messages
};

double scale_of(const CanSignal& signal) { return signal.step / signal.unit.in_si; }

std::int64_t raw_max_of(const CanSignal& signal, std::size_t tools) {
  if (signal.meaning == CanMeaning::tool) return static_cast<std::int64_t>(tools) - 1;
  std::int64_t named = -1;
  for (const CanValueName& name : signal.names) named = std::max<std::int64_t>(named, name.value);
  return named >= 0 ? named : signal.raw_max();
}

// Multiplexor: "M"; selected by its first value 5: "m5"; both: "m5M".
std::string multiplexing_of(const CanMessageLayout& layout, const CanSignal& signal) {
  std::string text;
  if (!signal.selector.empty()) text = " m" + std::to_string(signal.selected_by[0].first);
  const bool selects = std::ranges::any_of(
      layout.signals, [&](const CanSignal& other) { return other.selector == signal.name; });
  if (selects) text += text.empty() ? " M" : "M";
  return text;
}

class DbcWriter {
 public:
  explicit DbcWriter(const DbcBus& bus) : bus_(bus), prefixes_(dbc_prefixes(bus.tools)) {
    for (std::size_t t = 0; t < bus.tools.size(); ++t) {
      for (const CanMessageLayout& layout : k_can_messages) {
        if (layout.rule != CanIdentifierRule::of_tool) continue;
        messages_.push_back({layout, identifier_of(layout, bus.address, static_cast<int>(t)),
                             prefixes_[t] + std::string(layout.name), bus.tools[t]});
      }
    }
    for (const CanMessageLayout& layout : k_can_messages) {
      const bool absent = layout.rule == CanIdentifierRule::of_cell && bus.address.buttons == 0;
      if (layout.rule == CanIdentifierRule::of_tool || absent) continue;
      messages_.push_back(
          {layout, identifier_of(layout, bus.address), std::string(layout.name), {}});
    }
  }

  std::string write() {
    text_ =
        "VERSION \"1\"\n\nNS_ :\n\tCM_\n\tBA_DEF_\n\tBA_\n\tVAL_\n\tBA_DEF_DEF_\n"
        "\tSG_MUL_VAL_\n\nBS_:\n\nBU_: Glint Controller\n\n";
    for (const DbcMessage& message : messages_) add_message(message);
    text_ +=
        "CM_ \"Glint: poses of hand-held tools. They hold in the frame that the cell file "
        "gives: robot, world or camera.\";\n";
    for (const DbcMessage& message : messages_) add_comments(message);
    text_ += k_attributes;
    for (const DbcMessage& message : messages_) add_attributes(message);
    for (const DbcMessage& message : messages_) add_names(message);
    for (const DbcMessage& message : messages_) add_selectors(message);
    return text_;
  }

 private:
  void add_message(const DbcMessage& message) {
    const bool received = message.layout.rule == CanIdentifierRule::of_cell;
    text_ += "BO_ " + std::to_string(message.identifier) + " " + message.name + ": " +
             std::to_string(message.layout.bytes) + " " + k_nodes[received ? 1 : 0] + "\n";
    for (const CanSignal& signal : message.layout.signals) {
      const double scale = scale_of(signal);
      const auto physical = [&](std::int64_t raw) {
        return number_text(scale * static_cast<double>(raw));
      };
      const char* const order = signal.field.coding == CanCoding::motorola ? "@0" : "@1";
      text_ += " SG_ " + std::string(signal.name) + multiplexing_of(message.layout, signal) +
               " : " + std::to_string(signal.field.start) + "|" +
               std::to_string(signal.field.width) + order + (signal.is_signed() ? "- (" : "+ (") +
               number_text(scale) + ",0) [" + physical(signal.raw_min()) + "|" +
               physical(raw_max_of(signal, bus_.tools.size())) + "] " +
               dbc_string(signal.unit.name) + " " + k_nodes[received ? 0 : 1] + "\n";
    }
    text_ += "\n";
  }

  void add_comments(const DbcMessage& message) {
    const std::string identifier = std::to_string(message.identifier);
    const std::string tool = message.tool.empty() ? "" : "Tool " + message.tool + ". ";
    text_ += "CM_ BO_ " + identifier + " " +
             dbc_string(tool + std::string(message.layout.comment)) + ";\n";
    for (const CanSignal& signal : message.layout.signals) {
      std::string comment(signal.comment);
      if (signal.meaning == CanMeaning::saturating) {
        if (!comment.empty()) comment += ' ';
        comment += number_text(scale_of(signal) * static_cast<double>(signal.raw_max()));
        comment += ": this or more, or unknown.";
      }
      if (comment.empty()) continue;
      text_ += "CM_ SG_ " + identifier + " " + std::string(signal.name) + " " +
               dbc_string(comment) + ";\n";
    }
  }

  void add_attribute(const char* name, const DbcMessage& message, long value) {
    text_ += "BA_ \"" + std::string(name) + "\" BO_ " + std::to_string(message.identifier) + " " +
             std::to_string(value) + ";\n";
  }

  void add_attributes(const DbcMessage& message) {
    const CanMessageLayout& layout = message.layout;
    if (is_fd(layout.format)) {
      add_attribute("VFrameFormat", message, k_standard_can_fd);
      add_attribute("CANFD_BRS", message, 1);
    }
    if (!layout.sent_in(bus_.format) || layout.period_ms == k_can_on_event) return;
    const bool each_tick = layout.period_ms == k_can_each_tick;
    add_attribute("GenMsgCycleTime", message,
                  each_tick ? std::lround(1e3 / bus_.tick_hz) : layout.period_ms);
  }

  void add_names(const DbcMessage& message) {
    for (const CanSignal& signal : message.layout.signals) {
      std::string values;
      for (const CanValueName& name : signal.names)
        values += std::to_string(name.value) + " " + dbc_string(name.name) + " ";
      if (signal.meaning == CanMeaning::tool) {
        for (std::size_t t = 0; t < prefixes_.size(); ++t)
          values += std::to_string(t) + " " + dbc_string(prefixes_[t]) + " ";
      }
      if (values.empty()) continue;
      text_ += "VAL_ " + std::to_string(message.identifier) + " " + std::string(signal.name) + " " +
               values + ";\n";
    }
  }

  void add_selectors(const DbcMessage& message) {
    for (const CanSignal& signal : message.layout.signals) {
      if (signal.selector.empty()) continue;
      text_ += "SG_MUL_VAL_ " + std::to_string(message.identifier) + " " +
               std::string(signal.name) + " " + std::string(signal.selector);
      const char* separator = " ";
      for (const CanValueRange& range : signal.selected_by) {
        text_ += separator + std::to_string(range.first) + "-" + std::to_string(range.last);
        separator = ", ";
      }
      text_ += ";\n";
    }
  }

  const DbcBus& bus_;
  std::vector<std::string> prefixes_;
  std::vector<DbcMessage> messages_;
  std::string text_;
};

}  // namespace

std::vector<std::string> dbc_prefixes(const std::vector<std::string>& tools) {
  std::vector<std::string> prefixes;
  for (const std::string& tool : tools) {
    std::string prefix = prefix_of(tool);
    const bool taken = std::ranges::find(prefixes, prefix) != prefixes.end();
    if (taken) prefix.append(1, '_').append(std::to_string(prefixes.size()));
    prefixes.push_back(prefix);
  }
  return prefixes;
}

std::string dbc_text(const DbcBus& bus) { return DbcWriter(bus).write(); }

}  // namespace glint
