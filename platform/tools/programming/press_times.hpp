// Parses the intervals in which the pen's button was held: "1.0..2.5,3.0..4.2".
#pragma once

#include <string>
#include <vector>

#include "platform/sinks/record/button_event.hpp"

namespace glint {

// text: rising intervals FROM..TO in seconds on the recording's clock (tick_s in `samples.csv`).
// Returns the press and release events of draw. Throws InputError that quotes the wrong text.
[[nodiscard]] std::vector<ButtonEvent> press_times(const std::string& text);

}  // namespace glint
