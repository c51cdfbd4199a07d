// C header of the pose messages' layout, from the table in kernels/wire/can_messages.hpp.
#pragma once

#include <string>

namespace glint {

// The text of controller/glint_can_layout.h: offsets, lengths, signals, steps and value names.
[[nodiscard]] std::string c_layout_text();

}  // namespace glint
