// A version of which buttons of the pen are held, as the tick group could read it.
#pragma once

#include <cstdint>

#include "kernels/units.hpp"

namespace glint {

struct PenButtonsRecord {
  std::uint64_t version = 0;  // as a tick's choice names it; 0 is no record: none was ever held
  Time time;                  // of the event that changed them
  std::uint8_t held = 0;      // in the bits of PoseSample::buttons

  bool operator==(const PenButtonsRecord&) const = default;
};

}  // namespace glint
