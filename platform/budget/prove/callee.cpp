#include "platform/budget/prove/callee.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <string_view>

namespace glint::prove {
namespace {

constexpr std::int64_t k_refused = -1;  // its instructions have no maximum

struct LibraryFunction {
  std::string_view name;
  std::int64_t base = 0;          // instructions of a call
  std::int64_t per_16_bytes = 0;  // of its third argument, rounded up
  bool returns = true;
};

// Declared, neither computed nor measured: a system's library is replaced without a new build of
// this program. A proof lists those that it uses.
constexpr std::array k_library = {
    LibraryFunction{"memcpy", 120, 16},
    LibraryFunction{"memmove", 120, 16},
    LibraryFunction{"memset", 120, 16},
    LibraryFunction{"memcmp", 120, 64},
    LibraryFunction{"bcmp", 120, 64},
    LibraryFunction{"sqrt", 120},
    LibraryFunction{"sqrtf", 120},
    LibraryFunction{"floor", 40},
    LibraryFunction{"ceil", 40},
    LibraryFunction{"trunc", 40},
    LibraryFunction{"round", 40},
    LibraryFunction{"nearbyint", 60},
    LibraryFunction{"rint", 40},
    LibraryFunction{"ERKStepReset", k_refused},  // SUNDIALS calls its vectors by pointers
    LibraryFunction{"ERKStepSetFixedStep", k_refused},
    LibraryFunction{"ERKStepEvolve", k_refused},
    LibraryFunction{"malloc", k_refused},
    LibraryFunction{"free", k_refused},
    LibraryFunction{"abort", 0, 0, false},
    LibraryFunction{"__stack_chk_fail", 0, 0, false},
    LibraryFunction{"__assert_fail", 0, 0, false},
    LibraryFunction{"_ZSt9terminatev", 0, 0, false},
    LibraryFunction{"_ZSt21__glibcxx_assert_failPKciS0_S0_", 0, 0, false},
};

const LibraryFunction* declared(std::string_view name) {
  const auto found = std::find_if(k_library.begin(), k_library.end(),
                                  [&](const LibraryFunction& one) { return one.name == name; });
  return found == k_library.end() ? nullptr : &*found;
}

std::uint32_t arm64_word(const ProgramCode& code, std::uint64_t address) {
  const std::span<const std::uint8_t> bytes = code.bytes_at(address);
  std::uint32_t word = 0;
  if (bytes.size() >= sizeof word) std::memcpy(&word, bytes.data(), sizeof word);
  return word;
}

// adrp x16, page; ldr x17, [x16, offset]; add x16, x16, offset; br x17
std::optional<std::uint64_t> arm64_stub_slot(const ProgramCode& code, std::uint64_t address) {
  constexpr std::uint32_t k_bti = 0xd503245f;
  if (arm64_word(code, address) == k_bti) address += 4;
  const std::uint32_t adrp = arm64_word(code, address), ldr = arm64_word(code, address + 4);
  if ((adrp & 0x9f00001f) != 0x90000010 || (ldr & 0xffc003ff) != 0xf9400211) return std::nullopt;
  const std::int64_t high = static_cast<std::int32_t>(adrp << 8) >> 13;  // signed 19 bits
  const std::int64_t pages = high * 4 + ((adrp >> 29) & 3);
  return (address & ~std::uint64_t{0xfff}) + static_cast<std::uint64_t>(pages * 4096) +
         ((ldr >> 10) & 0xfff) * 8;
}

Callee callee_at(const ProgramCode& code, std::uint64_t address) {
  const FunctionSymbol* function = code.function_at(address);
  if (function == nullptr) return {};
  for (const std::string& name : function->linker_names) {
    if (declared(name) != nullptr) return {{}, name};
  }
  return {address, {}};
}

Callee callee_through(const ProgramCode& code, std::uint64_t slot) {
  const LoadedSlot* loaded = code.slot_at(slot);
  if (loaded == nullptr) return {};
  if (!loaded->name.empty()) {
    const std::string name = loaded->name.substr(0, loaded->name.find('@'));
    return {{}, name};
  }
  return callee_at(code, loaded->address);
}

}  // namespace

std::optional<std::uint64_t> stub_slot(const ProgramCode& code, const Decoder& decoder,
                                       std::uint64_t address) {
  if (code.function_at(address) != nullptr) return std::nullopt;
  if (code.machine() == Machine::arm64) return arm64_stub_slot(code, address);
  std::optional<Instruction> first = decoder.at(address);
  if (first && first->text.starts_with("endbr64")) first = decoder.at(first->end());
  if (!first || first->flow != Flow::jump) return std::nullopt;
  return first->slot;
}

Callee callee_of(const ProgramCode& code, const Decoder& decoder, const Instruction& call) {
  if (call.slot) return callee_through(code, *call.slot);
  if (!call.target) return {};
  if (const auto slot = stub_slot(code, decoder, *call.target)) return callee_through(code, *slot);
  return callee_at(code, *call.target);
}

bool does_not_return(const ProgramCode& code, const Decoder& decoder, const Instruction& call) {
  const LibraryFunction* function = declared(callee_of(code, decoder, call).library);
  return function != nullptr && !function->returns;
}

LibraryCost library_cost(const std::string& name, std::optional<std::int64_t> bytes) {
  const LibraryFunction* function = declared(name);
  if (function == nullptr || function->base == k_refused)
    return {0, "a call of " + name + ", which has no declared cost"};
  if (function->per_16_bytes == 0) return {function->base, {}};
  if (!bytes || *bytes < 0) return {0, "a call of " + name + " with a computed size"};
  return {function->base + (*bytes + 15) / 16 * function->per_16_bytes, {}};
}

}  // namespace glint::prove
