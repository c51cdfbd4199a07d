#include "platform/budget/bus_frames.hpp"

#include <algorithm>
#include <map>

#include "kernels/wire/can_frames.hpp"
#include "kernels/wire/node_frames.hpp"
#include "platform/cells/toml_reader.hpp"
#include "platform/input_error.hpp"
#include "schedules/assessment.hpp"

namespace glint {
namespace {

constexpr std::int64_t k_heartbeat_gap_ns = 100'000'000;
constexpr std::int64_t k_time_pair_gap_ns = 1'000'000'000;
constexpr std::uint32_t k_heartbeat_identifier = 0x700;  // CiA 301
constexpr std::uint32_t k_emergency_identifier = 0x80;

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

}  // namespace

std::vector<CanMessage> own_frames_of(const Cell& cell, int tools) {
  std::vector<CanMessage> frames;
  const std::int64_t tick_ns = static_cast<std::int64_t>(1e9 / cell.tick_hz);
  const auto add = [&](const std::string& name, std::uint32_t identifier, CanFrameShape shape,
                       std::int64_t gap_ns) {
    CanMessage frame;
    frame.name = name;
    frame.identifier = identifier;
    frame.shape = shape;
    frame.period_ns = gap_ns;
    frame.deadline_ns = tick_ns;
    frame.node = k_own_can_node;
    frame.fifo = true;
    frames.push_back(frame);
  };
  const std::uint32_t base = cell.can.base_id;
  for (int t = 0; t < tools; ++t) {
    const std::uint32_t first = base + static_cast<std::uint32_t>(t) * k_can_tool_stride;
    const std::string tool = "tool " + std::to_string(t + 1);
    if (cell.can.fd) {
      add(tool + " pose", first + k_can_fd_pose, {64, false, true, true}, tick_ns);
      continue;
    }
    add(tool + " position", first + k_can_position, {}, tick_ns);
    add(tool + " orientation", first + k_can_orientation, {}, tick_ns);
    add(tool + " velocity", first + k_can_velocity, {}, tick_ns);
    add(tool + " angular velocity", first + k_can_angular_velocity, {}, tick_ns);
    add(tool + " quality", first + k_can_quality, {}, tick_ns);
  }
  const auto node = static_cast<std::uint32_t>(cell.can.node);
  add("heartbeat", k_heartbeat_identifier + node, {.data_bytes = 1}, k_heartbeat_gap_ns);
  add("time", base + k_can_time_sync, {}, k_time_pair_gap_ns);
  add("time follow-up", base + k_can_time_follow_up, {}, k_time_pair_gap_ns);
  for (int t = 0; t < tools; ++t) {
    // Lost; found one tick later at the earliest; not lost again within lost_after.
    add("emergency, tool " + std::to_string(t + 1), k_emergency_identifier + node, {},
        cell.lost_after.nanoseconds / 2);
    frames.back().jitter_ns = std::max<std::int64_t>(0, cell.lost_after.nanoseconds / 2 - tick_ns);
    frames.back().deadline_ns += frames.back().jitter_ns;
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
