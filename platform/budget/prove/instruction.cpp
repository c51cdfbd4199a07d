#include "platform/budget/prove/instruction.hpp"

#include <capstone/capstone.h>

#include <stdexcept>
#include <string_view>

#include "platform/budget/prove/register_effects.hpp"

namespace glint::prove {
namespace {

bool in_group(csh handle, const cs_insn& raw, unsigned group) {
  return cs_insn_group(handle, &raw, group);
}

void read_x86(csh handle, const cs_insn& raw, Instruction& instruction) {
  const cs_x86& x86 = raw.detail->x86;
  const bool has_operand = x86.op_count > 0;
  if (in_group(handle, raw, CS_GRP_RET)) {
    instruction.flow = Flow::returns;
  } else if (raw.id == X86_INS_UD2 || raw.id == X86_INS_HLT || raw.id == X86_INS_INT3) {
    instruction.flow = Flow::stops;
  } else if (in_group(handle, raw, CS_GRP_CALL)) {
    instruction.flow = Flow::call;
  } else if (raw.id == X86_INS_JMP || raw.id == X86_INS_LJMP) {
    instruction.flow = Flow::jump;
  } else if (in_group(handle, raw, CS_GRP_JUMP)) {
    instruction.flow = Flow::branch;
  }
  if (instruction.flow != Flow::next && instruction.flow != Flow::returns && has_operand) {
    const cs_x86_op& to = x86.operands[0];
    if (to.type == X86_OP_IMM) instruction.target = static_cast<std::uint64_t>(to.imm);
    if (to.type == X86_OP_MEM && to.mem.base == X86_REG_RIP && to.mem.index == X86_REG_INVALID) {
      instruction.slot = instruction.end() + static_cast<std::uint64_t>(to.mem.disp);
    }
  }
  instruction.repeats =
      instruction.flow == Flow::next && std::string_view(raw.mnemonic).starts_with("rep");
}

void read_arm64(csh handle, const cs_insn& raw, Instruction& instruction) {
  const cs_arm64& arm = raw.detail->arm64;
  if (raw.id == ARM64_INS_RET) {
    instruction.flow = Flow::returns;
  } else if (raw.id == ARM64_INS_BRK || raw.id == ARM64_INS_HLT) {
    instruction.flow = Flow::stops;
  } else if (raw.id == ARM64_INS_BL || raw.id == ARM64_INS_BLR) {
    instruction.flow = Flow::call;
  } else if (raw.id == ARM64_INS_BR) {
    instruction.flow = Flow::jump;
  } else if (raw.id == ARM64_INS_B) {
    instruction.flow =
        arm.cc == ARM64_CC_INVALID || arm.cc == ARM64_CC_AL ? Flow::jump : Flow::branch;
  } else if (in_group(handle, raw, CS_GRP_JUMP)) {
    instruction.flow = Flow::branch;
  }
  if (instruction.flow == Flow::next || instruction.flow == Flow::returns) return;
  for (int i = 0; i < arm.op_count; ++i) {  // the last one: tbz has a bit number before it
    const cs_arm64_op& operand = arm.operands[i];
    if (operand.type == ARM64_OP_IMM) instruction.target = static_cast<std::uint64_t>(operand.imm);
  }
}

}  // namespace

struct Decoder::Handle {
  csh capstone = 0;
  cs_insn* raw = nullptr;
};

Decoder::Decoder(const ProgramCode& code) : code_(code), handle_(std::make_unique<Handle>()) {
  const bool x86 = code.machine() == Machine::x86_64;
  if (cs_open(x86 ? CS_ARCH_X86 : CS_ARCH_ARM64, x86 ? CS_MODE_64 : CS_MODE_LITTLE_ENDIAN,
              &handle_->capstone) != CS_ERR_OK) {
    throw std::runtime_error("libcapstone cannot decode " + name_of(code.machine()));
  }
  cs_option(handle_->capstone, CS_OPT_DETAIL, CS_OPT_ON);
  handle_->raw = cs_malloc(handle_->capstone);
}

Decoder::~Decoder() {
  cs_free(handle_->raw, 1);
  cs_close(&handle_->capstone);
}

std::optional<Instruction> Decoder::at(std::uint64_t address) const {
  if (!code_.is_code(address)) return std::nullopt;
  const std::span<const std::uint8_t> bytes = code_.bytes_at(address);
  const std::uint8_t* next = bytes.data();
  std::size_t left = bytes.size();
  std::uint64_t at = address;
  if (!cs_disasm_iter(handle_->capstone, &next, &left, &at, handle_->raw)) return std::nullopt;
  const cs_insn& raw = *handle_->raw;
  Instruction instruction;
  instruction.address = address;
  instruction.size = raw.size;
  instruction.text = std::string(raw.mnemonic) + " " + raw.op_str;
  if (code_.machine() == Machine::x86_64) {
    read_x86(handle_->capstone, raw, instruction);
    read_x86_effects(handle_->capstone, raw, instruction);
  } else {
    read_arm64(handle_->capstone, raw, instruction);
    read_arm64_effects(handle_->capstone, raw, instruction);
  }
  // Flow that has no model here: loop, syscall, iret.
  if (instruction.flow == Flow::next &&
      (in_group(handle_->capstone, raw, CS_GRP_JUMP) ||
       in_group(handle_->capstone, raw, CS_GRP_BRANCH_RELATIVE) ||
       in_group(handle_->capstone, raw, CS_GRP_INT) ||
       in_group(handle_->capstone, raw, CS_GRP_IRET) || raw.id == 0)) {
    return std::nullopt;
  }
  return instruction;
}

}  // namespace glint::prove
