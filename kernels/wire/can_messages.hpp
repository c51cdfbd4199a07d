// Table of Glint's CAN messages: all that it sends or receives (terms: can_layout.hpp).
//
// Everything else derives from it: packing, decoding, the DBC file (`glint can dbc`), identifiers,
// the bus load and the check for equal identifiers. A new message is an entry here, filled by
// nodes/pack_can.cpp.
// Source:   poses: Glint's own; heartbeat and emergency: CiA 301, 7.2.7 and 7.2.8; time: AUTOSAR
//           Time Synchronization over CAN, 7.2.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "kernels/limits.hpp"
#include "kernels/reason.hpp"
#include "kernels/wire/can_layout.hpp"
#include "kernels/wire/can_pose_signals.hpp"

namespace glint {

// Error codes of an emergency: 0: the error is over; 0xFF00 + reason; 0xFF80 + kind of lost output.
inline constexpr std::uint32_t k_can_error_reason = 0xFF00;
inline constexpr std::uint32_t k_can_error_lost_output = 0xFF80;

namespace can_table {

inline constexpr std::array<CanValueName, 1> k_sync{{{0x20, "SyncWithCrc"}}};
inline constexpr std::array<CanValueName, 1> k_follow_up{{{0x28, "FollowUpWithCrc"}}};
inline constexpr std::array<CanValueName, 4> k_node_states{
    {{0, "boot_up"}, {4, "stopped"}, {5, "operational"}, {127, "pre_operational"}}};

inline constexpr std::array<CanSignal, 1> k_heartbeat{
    {{.name = "NodeState", .field = {0, 8}, .limit = 127, .names = k_node_states}}};
inline constexpr std::array<CanSignal, 6> k_time_sync{{
    {.name = "Type", .field = {7, 8, motorola}, .names = k_sync},
    {.name = "Crc", .field = {15, 8, motorola}},
    {.name = "Domain", .field = {23, 4, motorola}},
    {.name = "SequenceCounter", .field = {19, 4, motorola}},
    {.name = "UserByte", .field = {31, 8, motorola}},
    {.name = "Seconds", .field = {39, 32, motorola}, .unit = k_s},
}};
inline constexpr std::array<CanSignal, 7> k_time_follow_up{{
    {.name = "Type", .field = {7, 8, motorola}, .names = k_follow_up},
    {.name = "Crc", .field = {15, 8, motorola}},
    {.name = "Domain", .field = {23, 4, motorola}},
    {.name = "SequenceCounter", .field = {19, 4, motorola}},
    {.name = "SyncToGateway", .field = {26, 1, motorola}},
    {.name = "OverflowSeconds", .field = {25, 2, motorola}, .unit = k_s},
    {"Nanoseconds", {39, 32, motorola}, 1e-9, k_ns, 999'999'999},
}};
inline constexpr std::array<CanSignal, 4> k_buttons{{
    {.name = "Draw", .field = {0, 1}},
    {.name = "DeleteLast", .field = {1, 1}},
    {.name = "Undo", .field = {2, 1}},
    {.name = "Finish", .field = {3, 1}},
}};

// Names of the error codes, or of the reasons where `code` is 0.
constexpr std::array<CanValueName, k_reasons> named_reasons(std::uint32_t code) {
  std::array<CanValueName, k_reasons> names;
  for (std::uint32_t i = 0; i < k_reasons; ++i)
    names[i] = {i == 0 ? 0 : code + i, name_of(static_cast<Reason>(i))};
  return names;
}

inline constexpr auto k_reason_names = named_reasons(0);
inline constexpr std::array<CanValueName, 3> k_lost_outputs{
    {{1, "dds"}, {2, "recording"}, {3, "files"}}};
constexpr auto named_errors() {
  std::array<CanValueName, k_reasons + 3> names;
  std::ranges::copy(named_reasons(k_can_error_reason), names.begin());
  names[0].name = "error_over";
  names[k_reasons] = {k_can_error_lost_output + 1, "lost_dds"};
  names[k_reasons + 1] = {k_can_error_lost_output + 2, "lost_recording"};
  names[k_reasons + 2] = {k_can_error_lost_output + 3, "lost_files"};
  return names;
}
inline constexpr auto k_errors = named_errors();

constexpr std::uint32_t error_of(Reason reason) {
  return k_can_error_reason + static_cast<std::uint32_t>(reason);
}
constexpr CanValueRange k_error_over{0, 0};
constexpr CanValueRange k_overruns{error_of(Reason::overrun_skipped),
                                   error_of(Reason::overrun_stopped)};
constexpr CanValueRange k_before_overruns{k_can_error_reason + 1, k_overruns.first - 1};
constexpr CanValueRange k_after_overruns{k_overruns.last + 1, error_of(k_last_reason)};
inline constexpr std::array k_of_reason{
    k_error_over, CanValueRange{k_before_overruns.first, k_after_overruns.last}};
inline constexpr std::array k_of_tool{k_error_over, k_before_overruns, k_after_overruns};
inline constexpr std::array k_of_overrun{k_overruns};
inline constexpr std::array k_of_loss{
    CanValueRange{k_can_error_lost_output + 1, k_can_error_lost_output + 3}};
// Kinds of an overrun's emergency. The state of a tool that an overrun stopped is `lost`, 3, in the
// same byte: that selects its signals.
inline constexpr std::array<CanValueName, 3> k_overrun_kinds{
    {{1, "detected_ahead"}, {2, "missed"}, {3, "tool_lost"}}};
inline constexpr std::array k_of_activation{CanValueRange{1, 2}};
inline constexpr std::array k_of_stopped_tool{CanValueRange{3, 3}};
inline constexpr std::array<CanValueName, 2> k_groups{{{0, "frame"}, {1, "tick"}}};

constexpr CanSignal when(std::string_view selector, std::span<const CanValueRange> values,
                         CanSignal signal) {
  signal.selector = selector;
  signal.selected_by = values;
  return signal;
}

inline constexpr auto k_tool_index = CanMeaning::tool;
inline constexpr std::array<CanSignal, 12> k_emergency{{
    {.name = "ErrorCode", .field = {0, 16}, .names = k_errors},
    {.name = "ErrorRegister", .field = {16, 8}},
    when("ErrorCode", k_of_reason, {.name = "Reason", .field = {40, 8}, .names = k_reason_names}),
    when("ErrorCode", k_of_tool, {.name = "Tool", .field = {24, 8}, .meaning = k_tool_index}),
    when("ErrorCode", k_of_tool, {.name = "State", .field = {32, 8}, .names = k_states}),
    when("ErrorCode", k_of_tool,
         {.name = "Registration", .field = {48, 8}, .names = k_registrations}),
    when("ErrorCode", k_of_overrun,
         {.name = "Overrun", .field = {32, 8}, .names = k_overrun_kinds}),
    when("Overrun", k_of_activation, {.name = "RateGroup", .field = {24, 8}, .names = k_groups}),
    when("Overrun", k_of_activation,
         {.name = "AfterNode", .field = {56, 8}, .comment = "The last node that ran."}),
    when("Overrun", k_of_stopped_tool,
         {.name = "StoppedTool", .field = {24, 8}, .meaning = k_tool_index}),
    when("Overrun", k_of_stopped_tool,
         {.name = "StoppedRegistration", .field = {48, 8}, .names = k_registrations}),
    when("ErrorCode", k_of_loss, {.name = "LostOutput", .field = {24, 8}, .names = k_lost_outputs}),
}};

}  // namespace can_table

// Offsets are those of the published identifiers; a tool has 16.
inline constexpr std::array<CanMessageLayout, 12> k_can_messages{{
    {"Position", CanIdentifierRule::of_tool, 0, 8, CanFormat::classic, k_can_each_tick,
     can_table::k_position,
     "Position of the tip. E2E profile 1 (both), data identifier = CAN identifier. Valid 0: no "
     "pose, or it does not fit."},
    {"Orientation", CanIdentifierRule::of_tool, 1, 8, CanFormat::classic, k_can_each_tick,
     can_table::k_orientation,
     "Rotation by its smallest three quaternion components in the order x, y, z, w; the omitted "
     "one is positive and follows from unit length."},
    {"Velocity", CanIdentifierRule::of_tool, 2, 8, CanFormat::classic, k_can_each_tick,
     can_table::k_velocity, "Velocity of the tip. State 0: no pose, or it does not fit."},
    {"AngularVelocity", CanIdentifierRule::of_tool, 3, 8, CanFormat::classic, k_can_each_tick,
     can_table::k_angular_velocity,
     "Angular velocity about the frame's axes. State 0: no pose, or it does not fit."},
    {"Quality", CanIdentifierRule::of_tool, 4, 8, CanFormat::classic, k_can_each_tick,
     can_table::k_quality, "State, uncertainty and age of the pose."},
    {"PoseFd", CanIdentifierRule::of_tool, 8, 64, CanFormat::fd, k_can_each_tick,
     can_table::k_pose_fd,
     "The whole pose in one CAN FD frame. E2E profile 5, data identifier = CAN identifier. State 0 "
     "with zeros: no pose, or it does not fit."},
    {"CovarianceFd", CanIdentifierRule::of_tool, 9, 48, CanFormat::fd_covariance, k_can_each_tick,
     can_table::k_covariance_fd,
     "Covariance of the pose of the same counter: standard deviations and correlations of the "
     "position and of the rotation about the frame's axes. E2E profile 5, data identifier = CAN "
     "identifier. State 0 with zeros: no pose."},
    {"Heartbeat", CanIdentifierRule::of_node, 0x700, 1, CanFormat::classic, 100,
     can_table::k_heartbeat, "CANopen heartbeat; the first one is the boot-up message."},
    {"TimeSync", CanIdentifierRule::of_bus, 0xE, 8, CanFormat::classic, 1000,
     can_table::k_time_sync, "AUTOSAR CanTSyn SYNC with CRC-8H2F."},
    {"TimeFollowUp", CanIdentifierRule::of_bus, 0xF, 8, CanFormat::classic, 1000,
     can_table::k_time_follow_up, "AUTOSAR CanTSyn follow-up: when SYNC was sent."},
    {"Emergency", CanIdentifierRule::of_node, 0x80, 8, CanFormat::classic, k_can_on_event,
     can_table::k_emergency,
     "CANopen emergency: a tool is lost or found again, an activation overran, or output is lost "
     "(at most one a second and kind)."},
    {"PenButtons", CanIdentifierRule::of_cell, 0, 1, CanFormat::classic, k_can_on_event,
     can_table::k_buttons,
     "Received by Glint: the buttons held, at each change or periodically. Further bits and bytes "
     "are ignored."},
}};

// The message of this name; without one the program does not compile.
[[nodiscard]] consteval const CanMessageLayout& can_message(std::string_view name) {
  for (const CanMessageLayout& message : k_can_messages) {
    if (message.name == name) return message;
  }
  no_such_can_name();
  return k_can_messages[0];
}

// Number of messages that a predicate selects.
template <typename Predicate>
[[nodiscard]] constexpr int count_can_messages(const Predicate& selects) {
  return static_cast<int>(std::ranges::count_if(k_can_messages, selects));
}

// Frames of one pose in a format, and of the node: those with a period, once a tick at most.
[[nodiscard]] constexpr int can_frames_per_pose(CanFormat format) {
  return count_can_messages([&](const CanMessageLayout& m) {
    return m.rule == CanIdentifierRule::of_tool && m.sent_in(format);
  });
}
inline constexpr int k_can_periodic_frames =
    count_can_messages([](const CanMessageLayout& m) { return m.period_ms > 0; });

// Returns whether an identifier is one of the 16 of a tool; the bus' messages are among them.
[[nodiscard]] constexpr bool is_tool_can_identifier(std::uint32_t identifier,
                                                    const CanAddress& address, int tools) {
  return identifier >= address.base &&
         identifier - address.base < static_cast<std::uint32_t>(tools) * k_can_tool_stride;
}

}  // namespace glint
