// What a bounded queue to a slow device does when it is full.
#pragma once

#include <cstdint>

namespace glint {

enum class WhenFull : std::uint8_t {
  drop,  // and count: a run in real time must not wait
  wait,  // a run that is not in real time keeps everything: the caller sleeps until there is room
};

}  // namespace glint
