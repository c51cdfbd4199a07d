// Copies of blocks that make each cycle a loop with one entry. The paths stay the same.
//
// Source: Aho et al. 2006, section 9.7.6 (node splitting).
#pragma once

#include <vector>

#include "platform/budget/prove/function_graph.hpp"

namespace glint::prove {

// False if the copies exceed k_blocks_max.
[[nodiscard]] bool split_shared_cycles(std::vector<Block>& blocks);

}  // namespace glint::prove
