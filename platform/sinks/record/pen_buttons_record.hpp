// Version of the pen's held buttons, as an input of the tick group.
#pragma once

#include <cstdint>

#include "kernels/units.hpp"

namespace glint {

struct PenButtonsRecord {
  std::uint64_t version = 0;  // referenced by a tick's choice; 0 is not recorded: none held yet
  Time time;                  // of the event that changed them
  std::uint8_t held = 0;      // in the bits of PoseSample::buttons

  bool operator==(const PenButtonsRecord&) const = default;
};

}  // namespace glint
