// CAN encoding of a pose: five classic frames or one CAN FD frame for each tool.
//
// What:     PoseSample -> protected frames as in can_messages.hpp, with identifiers of 11 bits.
//   The counter is the tick number modulo 15 (FD: 256), so that all frames of one estimate share
//   it. Out of range: a position, rotation or velocity that does not fit is sent as zeros with
//   valid 0 or state none (FD: the whole pose with state none). An uncertainty, age or rms that
//   does not fit is sent as all ones, "this or more, or unknown". A Unix time before 1970 is sent
//   as 0. No value wraps. The quality message always carries the tracker's state, also if the
//   others are out of range.
// Cost:     quantising 23 numbers and a CRC over 40 (FD: 64) bytes.
// Worst:    data independent.
// Accuracy: nearest step of each field; orientation within 0.0037 deg (FD: 1e-7 deg).
// Source:   the layout is Glint's own: can_messages.hpp.
#pragma once

#include <cstdint>

#include "kernels/nonblocking.hpp"
#include "kernels/wire/can_frame.hpp"
#include "kernels/wire/pose_sample.hpp"

namespace glint {

inline constexpr std::uint32_t k_can_base_default = 0x1A0;

inline constexpr const CanMessageLayout& k_position_message = can_message("Position");
inline constexpr const CanMessageLayout& k_orientation_message = can_message("Orientation");
inline constexpr const CanMessageLayout& k_velocity_message = can_message("Velocity");
inline constexpr const CanMessageLayout& k_angular_velocity_message =
    can_message("AngularVelocity");
inline constexpr const CanMessageLayout& k_quality_message = can_message("Quality");
inline constexpr const CanMessageLayout& k_fd_message = can_message("PoseFd");
inline constexpr const CanMessageLayout& k_covariance_message = can_message("CovarianceFd");

// The largest base identifier for which the identifiers of all tools fit 11 bits.
inline constexpr std::uint32_t k_can_base_max =
    k_can_identifier_max - (k_tools_max - 1) * k_can_tool_stride - 0xF;

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
