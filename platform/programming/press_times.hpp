// When the pen's button was held, written by hand: "1.0..2.5,3.0..4.2".
#pragma once

#include <string>
#include <vector>

#include "platform/record/button_event.hpp"

namespace glint {

// Seconds on the recording's clock (tick_s in `samples.csv`), FROM..TO, rising; as presses of draw
// and their ends. Throws InputError naming what was found.
[[nodiscard]] std::vector<ButtonEvent> press_times(const std::string& text);

}  // namespace glint
