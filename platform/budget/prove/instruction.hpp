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

struct RegisterWrite {
  bool written = false;
  std::optional<std::int64_t> constant;  // the value written, if the instruction contains it
};

struct Instruction {
  std::uint64_t address = 0;
  int size = 0;
  Flow flow = Flow::next;
  std::optional<std::uint64_t> target;  // of a direct jump, branch or call
  std::optional<std::uint64_t> slot;    // address that an indirect jump or call reads
  bool repeats = false;                 // x86 rep: once for each unit of the count register
  RegisterWrite repetitions;            // of the register that `rep` counts down: x86 rcx
  RegisterWrite third_argument;         // of a copy, the number of bytes: x86 rdx, arm64 x2
  std::string text;

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
