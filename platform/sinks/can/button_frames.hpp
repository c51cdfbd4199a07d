// Decoder of the pen's button frame on CAN: the buttons held, sent periodically or at each change.
//
// Message PenButtons of kernels/wire/can_messages.hpp: identifier as set in the cell, 11 bits,
// classic or FD, at least one byte of data; a bit for each button, in the order of Button; 1: held.
// Further bytes are ignored, so that any digital input module with this layout works. CANopen
// modules (CiA 401) send inputs 1 to 8 in the first byte of 0x180 + node. Such modules add neither
// counter nor checksum, so none is required: the bus' own checksum protects the frame.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>

#include "kernels/units.hpp"
#include "kernels/wire/can_frame.hpp"
#include "platform/sinks/record/button_event.hpp"

namespace glint {

// Decodes a data frame of Linux (struct can_frame or canfd_frame). Returns nothing for another
// size, a remote request, an error message, or a length that is invalid for its kind of frame.
[[nodiscard]] std::optional<CanFrame> frame_of_socketcan(std::span<const std::uint8_t> bytes);

struct ButtonFrameCounts {
  std::uint64_t received = 0;  // valid button frames
  std::uint64_t refused = 0;   // all other frames
  std::uint64_t released = 0;  // buttons released because their sender timed out
  [[nodiscard]] bool any() const { return received + refused > 0; }
};

class ButtonFrames {
 public:
  using OnButton = std::function<void(const ButtonEvent&)>;

  // `on_button` may be empty; initially no button is held.
  ButtonFrames(std::uint32_t identifier, OnButton on_button, Duration timeout = k_button_timeout);

  // From one thread: calls `on_button` for each button whose state differs from the last frame's. A
  // frame that is invalid, or not a button frame, is counted as refused.
  void receive(const std::optional<CanFrame>& frame, Time arrived);

  // From the same thread: if the last button frame is older than the timeout, releases the held
  // buttons, with one event at `now` for each.
  void release_on_timeout(Time now);

  // From any thread.
  [[nodiscard]] ButtonFrameCounts counts() const noexcept;

 private:
  std::uint32_t identifier_;
  OnButton on_button_;
  Duration timeout_;
  Time last_;
  std::array<bool, k_button_count> held_{};
  std::atomic<std::uint64_t> received_{0}, refused_{0}, released_{0};
};

}  // namespace glint
