// CAN encoding of a pose: five classic frames or one CAN FD frame for each tool.
//
// What:     PoseSample -> protected frames. Bit numbers as in the Intel order of a DBC file.
//   classic, 8 bytes, E2E profile 1 (both), data identifier = CAN identifier:
//     all      CRC 0..7 | counter 8..11
//     base+0   x,y,z 17-bit signed, 0.05 mm: 12..28, 29..45, 46..62 | valid 63
//     base+1   omitted index 12..13 | three components 16-bit: 14.., 30.., 46..61 | state 62..63
//     base+2   0 12..13 | linear velocity 16-bit signed, 0.1 mm/s: 14.., 30.., 46.. | state 62..63
//     base+3   likewise the angular velocity, 1 mrad/s
//     base+4   state 12..14 | registration 15..16 | markers 17..20 | sigma position 0.01 mm 21..30
//              | sigma orientation 0.01 deg 31..40 | age 0.2 ms 41..51 | registration rms 0.1 mm
//              52..58 | buttons 59..61 | 0 62..63
//   FD, 64 bytes, E2E profile 5, data identifier = CAN identifier:
//     base+8   CRC 0..1 | counter 2 | byte 3: state bits 0..2, registration 3..4, buttons 5..7
//              | x,y,z i32 1 um 4..15 | x,y,z,w i32 2^-30 16..31 | velocity i16 0.1 mm/s 32..37
//              | angular velocity i16 1 mrad/s 38..43 | sigma position u16 0.01 mm 44 | sigma
//              orientation u16 0.01 deg 46 | age u16 0.1 ms 48 | markers u8 50 | registration rms
//              u8 0.1 mm 51 | Unix time of the measurement u64 ns 52..59 | frame sequence
//              u32 60..63
//   Tool k uses base + 16 k. The counter is the tick number modulo 15 (FD: 256), so that all frames
//   of one estimate share it.
//   Out of range: a position, rotation or velocity that does not fit is sent as zeros with valid 0
//   or state none (FD: the whole pose with state none). An uncertainty, age or rms that does not
//   fit is sent as all ones, "this or more, or unknown". A Unix time before 1970 is sent as 0.
//   No value wraps. base+4 always carries the tracker's state, also if the others are out of range.
// Cost:     quantising 23 numbers and a CRC over 40 (FD: 64) bytes.
// Worst:    data independent.
// Accuracy: nearest step of each field; orientation within 0.0037 deg (FD: 1e-7 deg).
// Source:   the layout is Glint's own, published in platform/sinks/can/glint.dbc.
#pragma once

#include <cstdint>

#include "kernels/nonblocking.hpp"
#include "kernels/wire/can_frame.hpp"
#include "kernels/wire/pose_sample.hpp"

namespace glint {

inline constexpr std::uint32_t k_can_base_default = 0x1A0;
inline constexpr std::uint32_t k_can_tool_stride = 0x10;

// Offsets from a tool's base identifier.
inline constexpr std::uint32_t k_can_position = 0;
inline constexpr std::uint32_t k_can_orientation = 1;
inline constexpr std::uint32_t k_can_velocity = 2;
inline constexpr std::uint32_t k_can_angular_velocity = 3;
inline constexpr std::uint32_t k_can_quality = 4;
inline constexpr std::uint32_t k_can_fd_pose = 8;

// The largest base identifier for which the identifiers of all tools fit 11 bits.
inline constexpr std::uint32_t k_can_base_max =
    k_can_identifier_max - (k_tools_max - 1) * k_can_tool_stride - 0xF;

// Steps of the fields, in SI.
inline constexpr double k_can_position_step_m = 0.05e-3;
inline constexpr double k_can_velocity_step_m_s = 0.1e-3;
inline constexpr double k_can_angular_velocity_step_rad_s = 1e-3;
inline constexpr double k_can_sigma_position_step_m = 0.01e-3;
inline constexpr double k_can_sigma_orientation_step_rad = 1.7453292519943295e-4;  // 0.01 deg
inline constexpr double k_can_age_step_s = 0.2e-3;
inline constexpr double k_can_rms_step_m = 0.1e-3;
inline constexpr double k_can_fd_position_step_m = 1e-6;
inline constexpr double k_can_fd_rotation_step = 0x1p-30;
inline constexpr double k_can_fd_age_step_s = 0.1e-3;

// Field values that mean "this or more, or unknown".
inline constexpr std::uint64_t k_can_sigma_over = 0x3FF;
inline constexpr std::uint64_t k_can_age_over = 0x7FF;
inline constexpr std::uint64_t k_can_rms_over = 0x7F;
inline constexpr std::uint64_t k_can_fd_word_over = 0xFFFF;
inline constexpr std::uint64_t k_can_fd_byte_over = 0xFF;

struct CanPacking {
  CanFormat format = CanFormat::classic;
  std::uint32_t base_identifier = k_can_base_default;  // <= k_can_base_max
  std::int64_t unix_offset_ns = 0;                     // Unix time - local monotonic time; FD only
};

// Adds one tool's frames, position first, because a controller waits for it. A tool number outside
// 0..k_tools_max - 1 adds one to frames.dropped.
void add_pose_frames(const PoseSample& sample, const CanPacking& packing,
                     CanFrames& frames) noexcept GLINT_NONBLOCKING;

}  // namespace glint
