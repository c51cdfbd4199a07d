// Maxima of loops that count: how often a loop jumps back if its start, step and end are constants
// of the machine code, or differ by constants.
#pragma once

#include <cstdint>
#include <optional>

#include "platform/budget/prove/register_values.hpp"

namespace glint::prove {

// Nothing if no test of the loop counts. A test counts if each pass executes it once, it alone can
// continue the pass, and both sides change by constants each pass.
[[nodiscard]] std::optional<std::int64_t> counted_jumps_back(const FunctionGraph& graph,
                                                             const Loop& loop,
                                                             const RegisterValues& values);

}  // namespace glint::prove
