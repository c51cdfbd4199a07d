// Which bounds of a proof file hold for a program: those whose machine code is the program's.
#pragma once

#include <string>

#include "platform/budget/proved_bounds.hpp"

namespace glint::prove {

// Throws InputError if the program is of another machine than the proofs.
[[nodiscard]] ProvedBounds bounds_of_program(const ProofFile& proofs, const std::string& program);

}  // namespace glint::prove
