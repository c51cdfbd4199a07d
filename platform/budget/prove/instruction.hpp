// One decoded machine instruction, reduced to what the flow of control needs.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "platform/budget/prove/program_code.hpp"

namespace glint::prove {

enum class Flow : std::uint8_t {
  next,     // continues with the following instruction
  jump,     // to `target`, or through `slot` or a register
  branch,   // to `target` or to the following instruction
  call,     // to `target`, or through `slot` or a register; then the following instruction
  returns,  // to the caller
  stops,    // traps: the program ends here
};

// Number of a general register under all its names: 0 to 15 as in x86-64's encoding (rax, rcx, rdx,
// rbx, rsp, rbp, rsi, rdi, r8 ..), 0 to 30 as in arm64's and 31 for sp.
using Register = int;
inline constexpr Register k_no_register = -1;
inline constexpr Register k_load_address = 63;  // where the program is loaded; never written

// A register's value before the instruction plus a constant, or the constant alone.
struct RegisterSum {
  Register base = k_no_register;
  std::int64_t offset = 0;
  bool narrow = false;  // of the lower 32 bits
};

enum class Condition : std::uint8_t {
  unknown,
  equal,
  not_equal,
  less,
  less_equal,
  greater,
  greater_equal,
  below,  // unsigned
  below_equal,
  above,
  above_equal,
};

// What the condition of a later branch compares.
struct Comparison {
  RegisterSum left, right;
  bool only_equality = false;  // the flags of an addition: nothing is stated about the order
};

struct Instruction {
  std::uint64_t address = 0;
  int size = 0;
  Flow flow = Flow::next;
  std::optional<std::uint64_t> target;  // of a direct jump, branch or call
  std::optional<std::uint64_t> slot;    // address that an indirect jump or call reads
  bool repeats = false;                 // x86 rep: once for each unit of rcx
  std::uint64_t written = 0;            // a bit for each register that it can change
  Register assigned = k_no_register;    // one of them, of a value that is a sum
  RegisterSum sum;
  bool sets_flags = false;
  std::optional<Comparison> compares;  // its flags, or its own condition
  Condition condition = Condition::unknown;
  std::string text;

  [[nodiscard]] bool writes(Register one) const { return (written >> one & 1) != 0; }
  [[nodiscard]] std::uint64_t end() const { return address + static_cast<std::uint64_t>(size); }
};

class Decoder {
 public:
  explicit Decoder(const ProgramCode& code);
  ~Decoder();
  Decoder(const Decoder&) = delete;
  Decoder& operator=(const Decoder&) = delete;

  // Nothing if the bytes are no instruction.
  [[nodiscard]] std::optional<Instruction> at(std::uint64_t address) const;

 private:
  struct Handle;
  const ProgramCode& code_;
  std::unique_ptr<Handle> handle_;
};

}  // namespace glint::prove
