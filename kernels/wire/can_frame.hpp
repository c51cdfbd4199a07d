// CAN frame (classic or FD) and the list of frames of one tick, independent of the bus driver.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>

#include "kernels/limits.hpp"
#include "kernels/wire/can_messages.hpp"

namespace glint {

struct CanFrame {
  std::uint32_t identifier = 0;
  std::uint8_t length = 0;  // bytes of data: 0..8, FD also 12,16,20,24,32,48,64
  bool extended = false;    // 29-bit identifier
  bool fd = false;
  bool bit_rate_switch = false;  // FD only
  std::array<std::uint8_t, 64> data{};

  [[nodiscard]] std::span<const std::uint8_t> bytes() const { return {data.data(), length}; }
};

// Frame of a message, with zeros as data.
[[nodiscard]] constexpr CanFrame frame_of(const CanMessageLayout& message,
                                          std::uint32_t identifier) noexcept {
  const bool fd = is_fd(message.format);
  return {.identifier = identifier,
          .length = static_cast<std::uint8_t>(message.bytes),
          .fd = fd,
          .bit_rate_switch = fd};
}

// Capacity for one tick: a pose of each tool, then the node's own frames.
inline constexpr int k_can_frames_per_pose_max =
    std::max(can_frames_per_pose(CanFormat::classic), can_frames_per_pose(CanFormat::fd));
inline constexpr int k_can_node_frames_max =
    k_can_periodic_frames + k_tools_max;  // at most one emergency a tool
inline constexpr int k_can_frames_max =
    k_tools_max * k_can_frames_per_pose_max + k_can_node_frames_max;

struct CanFrames {
  std::array<CanFrame, k_can_frames_max> items;
  int count = 0;
  std::uint32_t dropped = 0;  // frames that did not fit; 0 if a tick sends only the above

  void add(const CanFrame& frame) noexcept {
    if (count < k_can_frames_max)
      items[static_cast<std::size_t>(count++)] = frame;
    else
      ++dropped;
  }
  [[nodiscard]] std::span<const CanFrame> frames() const& {
    return {items.data(), static_cast<std::size_t>(count)};
  }
  std::span<const CanFrame> frames() && = delete;  // of a temporary it would dangle
};

}  // namespace glint
