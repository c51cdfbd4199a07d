// Event of a pen button: pressed or released.
#pragma once

#include <cstdint>

#include "kernels/units.hpp"

namespace glint {

enum class Button : std::uint8_t {
  draw = 0,         // held: the tip draws; a click: a waypoint
  delete_last = 1,  // pressed: deletes the last waypoint or stroke
  undo = 2,         // pressed: undoes the last change
  finish = 3,       // pressed: ends the path
};
inline constexpr int k_button_count = 4;

// Default of a cell's buttons.timeout_ms.
inline constexpr Duration k_button_timeout = milliseconds(10'000);

struct ButtonEvent {
  Time time;
  Button button = Button::draw;
  bool pressed = false;

  bool operator==(const ButtonEvent&) const = default;
};

}  // namespace glint
