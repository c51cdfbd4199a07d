// Builds the simulator's scenario from a cell.
#pragma once

#include "platform/cells/cell.hpp"
#include "platform/sim/scenario.hpp"

namespace glint {

// Throws InputError for an unusable trajectory or background file.
[[nodiscard]] sim::Scenario scenario_of(const Cell& cell);

// Builds the scenario with the device and tools of `drawn` as ground truth; `cell` states the
// results of their calibrations. Tool axes and tips are those of `cell`. Throws InputError: a tool
// with another number of markers.
[[nodiscard]] sim::Scenario scenario_of(const Cell& cell, const Cell& drawn);

}  // namespace glint
