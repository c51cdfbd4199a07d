// How often g++ repeats `rep stosq` or `rep movsq` where it starts at an aligned address inside of
// a structure.
#pragma once

#include <cstdint>
#include <optional>

#include "platform/budget/prove/register_values.hpp"

namespace glint::prove {

// Recognised is, in one block and possibly between other instructions,
//   and rdi, -8; sub start, rdi; lea ecx, [start + bytes]; shr ecx, 3
// where start and rdi have one origin before. The mask lowers rdi by at most 7. Nothing for any
// other form.
[[nodiscard]] std::optional<std::int64_t> words_cleared(const std::vector<Block>& blocks, int block,
                                                        std::size_t repeat,
                                                        const RegisterValues& values);

}  // namespace glint::prove
