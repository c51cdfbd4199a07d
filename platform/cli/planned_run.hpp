// A run by a plan file, with the bounds that a board's costs give.
#pragma once

#include <string>

#include "platform/session/run_plan.hpp"

namespace glint {

// Throws InputError for a board of another build, a plan that does not validate, or one without
// the other. Both empty: by rule, without bounds.
[[nodiscard]] RunPlan planned_run(const Cell& cell, const std::string& board,
                                  const std::string& plan);

}  // namespace glint
