// Schedule of a run from a plan file, with the bounds that follow from a board's costs.
#pragma once

#include <string>

#include "platform/runtime/session/run_schedule.hpp"

namespace glint {

// Throws InputError for a board of another build, an invalid plan, or one without the other. Both
// empty: schedule by rule, without bounds.
[[nodiscard]] RunSchedule planned_run(const Cell& cell, const std::string& board,
                                      const std::string& plan);

}  // namespace glint
