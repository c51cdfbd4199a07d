// The simulator's scenario that a cell asks for.
#pragma once

#include "platform/cells/cell.hpp"
#include "platform/sim/scenario.hpp"

namespace glint {

// Throws InputError for a trajectory or background file that cannot be used.
[[nodiscard]] sim::Scenario scenario_of(const Cell& cell);

// The device and the tools that another cell's statements draw, of which `cell` states what their
// calibrations found: each tool's axes and tip are where `cell` has them. Throws InputError: a tool
// with another number of markers.
[[nodiscard]] sim::Scenario scenario_of(const Cell& cell, const Cell& drawn);

}  // namespace glint
