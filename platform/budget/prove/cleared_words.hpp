// How often g++ repeats `rep stosq` where it clears a structure from its first aligned byte on.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "platform/budget/prove/instruction.hpp"

namespace glint::prove {

// Recognised is, in one block and possibly between other instructions,
//   lea rdi, [start + 8]; and rdi, -8; mov rcx, start; sub rcx, rdi; add ecx, bytes; shr ecx, 3
// or the same with a copy of rdi as the start and `add rdi, 8`. There rdi is above start, so the
// count is at most bytes / 8. Nothing for any other form.
[[nodiscard]] std::optional<std::int64_t> words_cleared(const std::vector<Instruction>& block,
                                                        std::size_t repeat);

}  // namespace glint::prove
