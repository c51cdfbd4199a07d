// The simulator's scenario that a cell asks for.
#pragma once

#include "platform/cells/cell.hpp"
#include "platform/sim/scenario.hpp"

namespace glint {

// Throws InputError for a trajectory or background file that cannot be used.
[[nodiscard]] sim::Scenario scenario_of(const Cell& cell);

}  // namespace glint
