// Signals of a pose on CAN: those of the five classic messages and of the FD message.
//
// Classic, 8 bytes: E2E profile 1 (both), data identifier = CAN identifier; the counter is the tick
// number modulo 15. FD, 64 bytes, and 48 of a covariance: E2E profile 5, counter modulo 256. All
// frames of one estimate share the counter.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string_view>

#include "kernels/limits.hpp"
#include "kernels/wire/can_layout.hpp"

namespace glint {
namespace can_table {

using enum CanCoding;

inline constexpr CanUnit k_mm{"mm", 1e-3}, k_mm_s{"mm/s", 1e-3}, k_rad_s{"rad/s", 1},
    k_deg{"deg", 1.7453292519943295e-2}, k_ms{"ms", 1e-3}, k_s{"s", 1}, k_ns{"ns", 1e-9};

inline constexpr std::array<CanValueName, 4> k_states{
    {{0, "none"}, {1, "predicted"}, {2, "measured"}, {3, "lost"}}};
inline constexpr std::array<CanValueName, 4> k_registrations{
    {{0, "none"}, {1, "given"}, {2, "accepted"}, {3, "refused"}}};
inline constexpr std::array<CanValueName, 2> k_valid{{{0, "invalid"}, {1, "valid"}}};
inline constexpr std::array<CanValueName, 4> k_components{{{0, "x"}, {1, "y"}, {2, "z"}, {3, "w"}}};

inline constexpr CanSignal k_crc{.name = "Crc", .field = {0, 8}};
inline constexpr CanSignal k_counter{.name = "Counter", .field = {8, 4}, .limit = 14};
inline constexpr CanSignal k_state{.name = "State", .field = {62, 2}, .names = k_states};

// x, y and z of a vector, successive in the frame.
constexpr std::array<CanSignal, 3> axes(const std::array<std::string_view, 3>& names,
                                        const CanField& x, double step, const CanUnit& unit,
                                        std::int64_t limit) {
  std::array<CanSignal, 3> result;
  for (std::size_t i = 0; i < 3; ++i) {
    const int start = x.start + static_cast<int>(i) * x.width;
    result[i] = {.name = names[i],
                 .field = {start, x.width, x.coding},
                 .step = step,
                 .unit = unit,
                 .limit = limit};
  }
  return result;
}

inline constexpr std::int64_t k_word_max = 0x7FFF;      // symmetric: no -32768
inline constexpr std::int64_t k_long_max = 0x7FFFFFFF;  // likewise
inline constexpr std::array<std::string_view, 3> k_xyz{"X", "Y", "Z"};
inline constexpr auto k_position_axes = axes(k_xyz, {12, 17, intel_signed}, 0.05e-3, k_mm, 0);
inline constexpr double k_component_step = 2.1580187e-5;  // x 32767 = 0.70712 > 1/sqrt(2)
inline constexpr auto k_component_axes =
    axes({"Component0", "Component1", "Component2"}, {14, 16, intel_signed}, k_component_step, {},
         k_word_max);
inline constexpr auto k_velocity_axes =
    axes(k_xyz, {14, 16, intel_signed}, 0.1e-3, k_mm_s, k_word_max);
inline constexpr auto k_angular_velocity_axes =
    axes(k_xyz, {14, 16, intel_signed}, 1e-3, k_rad_s, k_word_max);

inline constexpr std::array<CanSignal, 6> k_position{
    {k_crc,
     k_counter,
     k_position_axes[0],
     k_position_axes[1],
     k_position_axes[2],
     {.name = "Valid", .field = {63, 1}, .names = k_valid}}};
inline constexpr std::array<CanSignal, 7> k_orientation{
    {k_crc,
     k_counter,
     {.name = "LeftOut", .field = {12, 2}, .names = k_components},
     k_component_axes[0],
     k_component_axes[1],
     k_component_axes[2],
     k_state}};
inline constexpr std::array<CanSignal, 6> k_velocity{
    {k_crc, k_counter, k_velocity_axes[0], k_velocity_axes[1], k_velocity_axes[2], k_state}};
inline constexpr std::array<CanSignal, 6> k_angular_velocity{
    {k_crc, k_counter, k_angular_velocity_axes[0], k_angular_velocity_axes[1],
     k_angular_velocity_axes[2], k_state}};

inline constexpr std::string_view k_sigma_comment = "One standard deviation an axis.";
inline constexpr double k_hundredth_deg = 1.7453292519943295e-4;
inline constexpr auto k_or_more = CanMeaning::saturating;
inline constexpr std::array<CanSignal, 10> k_quality{{
    k_crc,
    k_counter,
    {.name = "State", .field = {12, 3}, .names = k_states},
    {.name = "Registration", .field = {15, 2}, .names = k_registrations},
    {.name = "Markers", .field = {17, 4}, .limit = k_markers_per_tool_max},
    {"SigmaPosition", {21, 10}, 0.01e-3, k_mm, 0, k_or_more, {}, {}, {}, k_sigma_comment},
    {"SigmaOrientation",
     {31, 10},
     k_hundredth_deg,
     k_deg,
     0,
     k_or_more,
     {},
     {},
     {},
     k_sigma_comment},
    {"Age", {41, 11}, 0.2e-3, k_ms, 0, k_or_more, {}, {}, {}, "Of the measurement when sent."},
    {"RegistrationRms", {52, 7}, 0.1e-3, k_mm, 0, k_or_more},
    {.name = "Buttons",
     .field = {59, 3},
     .comment = "Of the first tool, held when the tick began, with or without a pose: 1 draw, 2 "
                "delete_last, 4 undo. Of other tools 0."},
}};

inline constexpr auto k_fd_position = axes(k_xyz, {32, 32, intel_signed}, 1e-6, k_mm, k_long_max);
inline constexpr auto k_fd_rotation =
    axes({"RotationX", "RotationY", "RotationZ"}, {128, 32, intel_signed}, 0x1p-30, {}, k_long_max);
inline constexpr auto k_fd_velocity = axes({"VelocityX", "VelocityY", "VelocityZ"},
                                           {256, 16, intel_signed}, 0.1e-3, k_mm_s, k_word_max);
inline constexpr auto k_fd_angular_velocity =
    axes({"AngularVelocityX", "AngularVelocityY", "AngularVelocityZ"}, {304, 16, intel_signed},
         1e-3, k_rad_s, k_word_max);
inline constexpr std::array<CanSignal, 25> k_pose_fd{{
    {.name = "Crc", .field = {0, 16}},
    {.name = "Counter", .field = {16, 8}},
    {.name = "State", .field = {24, 3}, .names = k_states},
    {.name = "Registration", .field = {27, 2}, .names = k_registrations},
    {.name = "Buttons", .field = {29, 3}, .comment = "As in the classic quality message."},
    k_fd_position[0],
    k_fd_position[1],
    k_fd_position[2],
    k_fd_rotation[0],
    k_fd_rotation[1],
    k_fd_rotation[2],
    {"RotationW", {224, 32, intel_signed}, 0x1p-30, {}, k_long_max},
    k_fd_velocity[0],
    k_fd_velocity[1],
    k_fd_velocity[2],
    k_fd_angular_velocity[0],
    k_fd_angular_velocity[1],
    k_fd_angular_velocity[2],
    {"SigmaPosition", {352, 16}, 0.01e-3, k_mm, 0, k_or_more, {}, {}, {}, k_sigma_comment},
    {"SigmaOrientation",
     {368, 16},
     k_hundredth_deg,
     k_deg,
     0,
     k_or_more,
     {},
     {},
     {},
     k_sigma_comment},
    {"Age", {384, 16}, 0.1e-3, k_ms, 0, k_or_more, {}, {}, {}, "Of the measurement when sent."},
    {.name = "Markers", .field = {400, 8}, .limit = k_markers_per_tool_max},
    {"RegistrationRms", {408, 8}, 0.1e-3, k_mm, 0, k_or_more},
    {.name = "MeasurementTime",
     .field = {416, 64},
     .step = 1e-9,
     .unit = k_ns,
     .limit = std::numeric_limits<std::int64_t>::max(),
     .comment = "Unix time of mid-exposure. 0: unknown."},
    {.name = "FrameSequence", .field = {480, 32}},
}};

// Rows and columns of a pose's covariance, and the correlations of its upper triangle, row by row.
inline constexpr std::size_t k_pose_axes = 6;
inline constexpr std::array<std::string_view, k_pose_axes> k_covariance_sigmas{
    "SigmaX", "SigmaY", "SigmaZ", "SigmaRotationX", "SigmaRotationY", "SigmaRotationZ"};
inline constexpr std::array<std::string_view, 15> k_correlations{
    "CorrelationXY",  "CorrelationXZ",  "CorrelationXRx",  "CorrelationXRy",  "CorrelationXRz",
    "CorrelationYZ",  "CorrelationYRx", "CorrelationYRy",  "CorrelationYRz",  "CorrelationZRx",
    "CorrelationZRy", "CorrelationZRz", "CorrelationRxRy", "CorrelationRxRz", "CorrelationRyRz"};
inline constexpr double k_correlation_step = 1.0 / static_cast<double>(k_word_max);
inline constexpr int k_first_sigma_bit = 32;
constexpr auto covariance_signals() {
  std::array<CanSignal, 3 + k_pose_axes + k_correlations.size()> signals{};
  signals[0] = {.name = "Crc", .field = {0, 16}};
  signals[1] = {.name = "Counter", .field = {16, 8}};
  signals[2] = {.name = "State", .field = {24, 3}, .names = k_states};
  int bit = k_first_sigma_bit;
  std::size_t at = 3;
  for (std::size_t i = 0; i < k_pose_axes; ++i, bit += 16) {
    const bool moves = i < 3;
    signals[at++] = {.name = k_covariance_sigmas[i],
                     .field = {bit, 16},
                     .step = moves ? 0.01e-3 : k_hundredth_deg,
                     .unit = moves ? k_mm : k_deg,
                     .meaning = k_or_more};
  }
  for (const std::string_view name : k_correlations) {
    signals[at++] = {.name = name,
                     .field = {bit, 16, intel_signed},
                     .step = k_correlation_step,
                     .limit = k_word_max};
    bit += 16;
  }
  return signals;
}
inline constexpr auto k_covariance_fd = covariance_signals();

}  // namespace can_table
}  // namespace glint
