// CAN frames of a node: heartbeat, emergency and time synchronisation.
//
// What:     CANopen heartbeat and emergency, AUTOSAR CanTSyn SYNC and follow-up.
// Cost:     at most one CRC over 7 bytes.
// Worst:    data independent.
// Accuracy: time to the nanosecond.
// Source:   CiA 301, 7.2.7 (EMCY) and 7.2.8 (heartbeat); AUTOSAR Time Synchronization over CAN,
//           7.2.
#pragma once

#include <array>
#include <cstdint>

#include "kernels/nonblocking.hpp"
#include "kernels/reason.hpp"
#include "kernels/result.hpp"
#include "kernels/wire/can_frame.hpp"
#include "kernels/wire/pose_sample.hpp"

namespace glint {

enum class CanNodeState : std::uint8_t {
  boot_up = 0x00,
  stopped = 0x04,
  operational = 0x05,
  pre_operational = 0x7F
};

// Identifier 0x700 + node, node 1..127 (modulo 128).
[[nodiscard]] CanFrame heartbeat_frame(unsigned node,
                                       CanNodeState state) noexcept GLINT_NONBLOCKING;

// Identifier 0x80 + node. Error code FF00 + reason (0000: error reset), error register 81 (generic,
// manufacturer specific), then tool, track state, reason, registration state, 0.
[[nodiscard]] CanFrame emergency_frame(unsigned node,
                                       const PoseSample& sample) noexcept GLINT_NONBLOCKING;

// Emergency frame for an activation with an overrun. Identifier and error code as above. The byte
// of the tool holds the rate group (0 frame, 1 tick), that of the state the kind (1 detected ahead,
// 2 missed); then the reason, 0, and the last node that ran.
struct OverrunEmergency {
  std::uint8_t group = 0;
  std::uint8_t kind = 0;
  Reason reason = Reason::overrun_skipped;
  std::uint8_t after_node = 0;
};
[[nodiscard]] CanFrame overrun_frame(unsigned node, const OverrunEmergency& overrun) noexcept;

// Emergency frame for lost output: error code FF80 + kind, the kind in the tool's byte, the rest 0.
[[nodiscard]] CanFrame lost_output_frame(unsigned node, std::uint8_t kind) noexcept;

// Both frames of one pair carry the same sequence counter (0..15) and domain.
struct TimeSync {
  std::uint32_t base_identifier = 0x1A0;
  std::uint8_t domain = 0;  // 0..15
  std::array<std::uint8_t, 16> data_ids{0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};
};

// SYNC: the whole seconds of `unix_ns`, the time just before it is sent. Returns
// Reason::out_of_range for a time outside 1970..2106 (a field of 32 bits).
[[nodiscard]] Result<CanFrame> time_sync_frame(const TimeSync& sync, std::uint8_t counter,
                                               std::int64_t unix_ns) noexcept GLINT_NONBLOCKING;

// Follow-up: the time at which the SYNC was sent. The field has two bits for whole seconds since
// those of SYNC. Returns Reason::out_of_range for more, or for a time before SYNC's seconds.
[[nodiscard]] Result<CanFrame> time_follow_up_frame(
    const TimeSync& sync, std::uint8_t counter, std::int64_t sync_unix_ns,
    std::int64_t sent_unix_ns) noexcept GLINT_NONBLOCKING;

}  // namespace glint
