#include "platform/budget/bus_frames.hpp"

#include <algorithm>
#include <map>
#include <string_view>

#include "kernels/wire/can_messages.hpp"
#include "platform/cells/toml_reader.hpp"
#include "platform/input_error.hpp"
#include "schedules/assessment.hpp"

namespace glint {
namespace {

std::int64_t ns_of(double ms) { return static_cast<std::int64_t>(ms * 1e6 + 0.5); }

class ForeignReader {
 public:
  ForeignReader(const std::string& file, const std::vector<CanMessage>& own)
      : file_(file), own_(own) {}

  std::vector<CanMessage> read(const toml::table& root) {
    TomlReader reader(root, file_, "");
    for (const toml::table* frame : reader.tables("frame")) read_frame(*frame);
    reader.done();
    return frames_;
  }

 private:
  [[noreturn]] void complain(const toml::table& table, const std::string& what) const {
    throw InputError(file_ + ":" + std::to_string(table.source().begin.line) + ": " + what);
  }

  void read_frame(const toml::table& table) {
    TomlReader reader(table, file_, "frame.");
    CanMessage frame;
    frame.name = reader.text("name", "");
    frame.shape.extended = reader.boolean("extended", false);
    frame.shape.fd = reader.boolean("fd", false);
    frame.shape.bit_rate_switch = reader.boolean("bit_rate_switch", frame.shape.fd);
    if (table.get("identifier") == nullptr) complain(table, "no identifier; expected one");
    frame.identifier = static_cast<std::uint32_t>(
        reader.integer("identifier", 0, 0, frame.shape.extended ? 0x1FFFFFFF : 0x7FF));
    frame.shape.data_bytes =
        static_cast<int>(reader.integer("bytes", 8, 0, frame.shape.fd ? 64 : 8));
    if (table.get("period_ms") == nullptr) complain(table, "no period_ms; expected one");
    const double period_ms = reader.real("period_ms", 0, 0.01, 3'600'000);
    frame.period_ns = ns_of(period_ms);
    frame.jitter_ns = ns_of(reader.real("jitter_ms", 0, 0, period_ms));
    frame.deadline_ns = ns_of(reader.real("deadline_ms", period_ms, 0.01, 3'600'000));
    frame.node = node_of(reader.text("node", "another node"));
    frame.fifo = reader.one_of("queue", "priority", {"priority", "fifo"}) == "fifo";
    reader.done();
    if (frame.name.empty()) frame.name = "frame " + std::to_string(frame.identifier);
    compare(table, frame);
    frames_.push_back(frame);
  }

  int node_of(const std::string& name) {
    const int next = static_cast<int>(nodes_.size()) + 1;
    return nodes_.emplace(name, k_own_can_node + next).first->second;
  }

  void compare(const toml::table& table, const CanMessage& frame) const {
    const auto same_identifier = [&](const CanMessage& other) {
      return other.identifier == frame.identifier && other.shape.extended == frame.shape.extended;
    };
    for (const CanMessage& own : own_) {
      if (!same_identifier(own)) continue;
      complain(table, "identifier " + std::to_string(frame.identifier) + " is also that of " +
                          own.name + "; expected an identifier that this cell does not send");
    }
    for (const CanMessage& other : frames_) {
      if (same_identifier(other)) {
        complain(table, "identifier " + std::to_string(frame.identifier) + " is also that of " +
                            other.name + "; expected each once");
      }
      if (other.node == frame.node && other.fifo != frame.fifo) {
        complain(table, "queue differs from that of " + other.name +
                            " of the same node; expected one kind a node");
      }
    }
  }

  const std::string& file_;
  const std::vector<CanMessage>& own_;
  std::map<std::string, int> nodes_;
  std::vector<CanMessage> frames_;
};

// "AngularVelocity" -> "angular velocity".
std::string words_of(std::string_view name) {
  std::string words;
  for (const char letter : name) {
    const bool upper = letter >= 'A' && letter <= 'Z';
    if (upper && !words.empty()) words += ' ';
    words += upper ? static_cast<char>(letter - 'A' + 'a') : letter;
  }
  return words;
}

CanMessage own_frame(const CanMessageLayout& message, const Cell& cell, int tool) {
  const std::int64_t tick_ns = shortest_tick_gap_of(cell).nanoseconds;
  const CanAddress address{cell.can.base_id, static_cast<std::uint32_t>(cell.can.node)};
  CanMessage frame;
  frame.name = words_of(message.name);
  frame.identifier = identifier_of(message, address, tool);
  frame.shape = shape_of(message);
  frame.period_ns =
      message.period_ms == k_can_each_tick ? tick_ns : milliseconds(message.period_ms).nanoseconds;
  frame.deadline_ns = tick_ns;
  frame.node = k_own_can_node;
  frame.fifo = true;
  const std::string number = "tool " + std::to_string(tool + 1);
  if (message.rule == CanIdentifierRule::of_tool) frame.name = number + " " + frame.name;
  if (message.period_ms == k_can_on_event) {
    frame.name += ", " + number;
    // Lost; found one tick later at the earliest; not lost again within lost_after.
    frame.period_ns = cell.lost_after.nanoseconds / 2;
    frame.jitter_ns = std::max<std::int64_t>(0, frame.period_ns - tick_ns);
    frame.deadline_ns += frame.jitter_ns;
  }
  return frame;
}

}  // namespace

std::vector<CanMessage> own_frames_of(const Cell& cell, int tools) {
  const CanFormat format = cell.can.format;
  const auto sent = [&](const CanMessageLayout& m) { return m.sent_in(format); };
  std::vector<CanMessage> frames;
  for (int t = 0; t < tools; ++t) {
    for (const CanMessageLayout& m : k_can_messages) {
      if (sent(m) && m.rule == CanIdentifierRule::of_tool) frames.push_back(own_frame(m, cell, t));
    }
  }
  for (const CanMessageLayout& m : k_can_messages) {
    if (!sent(m) || m.rule == CanIdentifierRule::of_tool) continue;
    const int times = m.period_ms == k_can_on_event ? tools : 1;
    for (int t = 0; t < times; ++t) frames.push_back(own_frame(m, cell, t));
  }
  return frames;
}

std::vector<CanMessage> foreign_frames_from_text(const std::string& text, const std::string& file,
                                                 const std::vector<CanMessage>& own) {
  return ForeignReader(file, own).read(parse_toml(text, file));
}

std::vector<CanMessage> foreign_frames(const std::string& file,
                                       const std::vector<CanMessage>& own) {
  return foreign_frames_from_text(read_text(file), file, own);
}

}  // namespace glint
