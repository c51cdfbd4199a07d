// Kernels of the tracker and output graphs with their loops' declared worst counts, by name.
#pragma once

#include <vector>

#include "kernels/limits.hpp"
#include "platform/budget/prove/prove.hpp"

namespace glint::prove {

// In the order of execution.
[[nodiscard]] std::vector<KernelCounts> kernel_counts(const Limits& limits);

// The names of a loop's maximum in loops.toml: the fields of Limits and the constants of the code.
[[nodiscard]] NamedCounts names_of(const Limits& limits);

}  // namespace glint::prove
