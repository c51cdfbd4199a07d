// Which registers an instruction changes, and by how much: what a loop's counting needs.
#pragma once

#include <capstone/capstone.h>

#include "platform/budget/prove/instruction.hpp"

namespace glint::prove {

// Both set `written`, `assigned`, `sum`, `sets_flags`, `compares` and `condition`. The flow of
// control and `target` are set before. A call keeps the registers that the ABI preserves.
void read_x86_effects(csh handle, const cs_insn& raw, Instruction& instruction);
void read_arm64_effects(csh handle, const cs_insn& raw, Instruction& instruction);

}  // namespace glint::prove
