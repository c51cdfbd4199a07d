// Overflow policy of a bounded queue to a slow device.
#pragma once

#include <cstdint>

namespace glint {

enum class OverflowPolicy : std::uint8_t {
  drop,  // and count: a real-time run must not wait
  wait,  // the caller sleeps until there is room: a run outside real time loses nothing
};

}  // namespace glint
