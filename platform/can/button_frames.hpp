// The pen's buttons as a CAN frame says them: which are held, again and again or at each change.
//
//   identifier as the cell has it, 11 bits, classic or FD, one byte of data at least
//   byte 0    bit 0 draw | bit 1 delete_last | bit 2 undo | bit 3 finish; 1: held
// What follows is not looked at, so that any digital input module serves that sends its inputs so:
// CANopen's (CiA 401) do, inputs 1 to 8 in the first byte of 0x180 + node. Such modules add neither
// counter nor checksum: none is asked for, and the bus' own checksum is what guards the frame.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>

#include "kernels/units.hpp"
#include "kernels/wire/can_frame.hpp"
#include "platform/record/button_event.hpp"

namespace glint {

// A data frame as Linux hands it over (struct can_frame or canfd_frame). Nothing for another size,
// a remote request, an error message, or a length that its kind of frame cannot have.
[[nodiscard]] std::optional<CanFrame> frame_of_socketcan(std::span<const std::uint8_t> bytes);

struct ButtonFrameCounts {
  std::uint64_t heard = 0;     // frames that said which buttons are held
  std::uint64_t refused = 0;   // frames that did not
  std::uint64_t released = 0;  // buttons whose sender fell silent
  [[nodiscard]] bool any() const { return heard + refused > 0; }
};

class ButtonFrames {
 public:
  using OnButton = std::function<void(const ButtonEvent&)>;

  // `on_button` may be empty; before the first frame no button is held.
  ButtonFrames(std::uint32_t identifier, OnButton on_button, Duration timeout = k_button_timeout);

  // From one thread: calls `on_button` for each button that this frame, arrived at that time, says
  // to be otherwise than the last did. A frame that is none or no buttons' is refused.
  void hear(const std::optional<CanFrame>& frame, Time arrived);

  // From the same thread: releases what is held if the last frame of buttons is older than the
  // timeout, with an event at `now` for each.
  void release_if_silent(Time now);

  // From any thread.
  [[nodiscard]] ButtonFrameCounts counts() const noexcept;

 private:
  std::uint32_t identifier_;
  OnButton on_button_;
  Duration timeout_;
  Time last_;
  std::array<bool, k_button_count> held_{};
  std::atomic<std::uint64_t> heard_{0}, refused_{0}, released_{0};
};

}  // namespace glint
