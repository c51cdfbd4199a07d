// What a call or a jump out of a function reaches: a function of the program, or a function of a
// library with a declared cost.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "platform/budget/prove/instruction.hpp"

namespace glint::prove {

struct Callee {
  std::optional<std::uint64_t> address;  // neither: the call cannot be resolved
  std::string library;
};

[[nodiscard]] Callee callee_of(const ProgramCode& code, const Decoder& decoder,
                               const Instruction& call);

// Slot through which a linker's stub at the address jumps; nothing if there is no stub.
[[nodiscard]] std::optional<std::uint64_t> stub_slot(const ProgramCode& code,
                                                     const Decoder& decoder, std::uint64_t address);

[[nodiscard]] bool does_not_return(const ProgramCode& code, const Decoder& decoder,
                                   const Instruction& call);

// Declared maximum of executed instructions in a library's function; or why there is none.
// `bytes`: the third argument, if it is a constant.
struct LibraryCost {
  std::int64_t instructions = 0;
  std::string refusal;
};
[[nodiscard]] LibraryCost library_cost(const std::string& name, std::optional<std::int64_t> bytes);

}  // namespace glint::prove
