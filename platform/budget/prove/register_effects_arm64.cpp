#include <string_view>

#include "platform/budget/prove/register_effects.hpp"

namespace glint::prove {
namespace {

// x19 to x29 and sp: Procedure Call Standard for the Arm 64-bit Architecture, section 6.1.1.
constexpr std::uint64_t k_arm64_kept_by_calls = 0xbff80000;
constexpr Register k_sp = 31;

Register arm64_register(unsigned id) {
  if (id >= ARM64_REG_X0 && id <= ARM64_REG_X28) return static_cast<Register>(id - ARM64_REG_X0);
  if (id >= ARM64_REG_W0 && id <= ARM64_REG_W30) return static_cast<Register>(id - ARM64_REG_W0);
  if (id == ARM64_REG_X29) return 29;
  if (id == ARM64_REG_X30) return 30;
  if (id == ARM64_REG_SP || id == ARM64_REG_WSP) return k_sp;
  return k_no_register;
}

bool is_arm64_narrow(unsigned id) {
  return (id >= ARM64_REG_W0 && id <= ARM64_REG_W30) || id == ARM64_REG_WSP || id == ARM64_REG_WZR;
}

void arm64_mark(Instruction& instruction, Register number) {
  if (number != k_no_register) instruction.written |= std::uint64_t{1} << number;
}

// Comparisons and plain stores only read their first operands.
bool arm64_only_reads(const cs_insn& raw) {
  const std::string_view name = raw.mnemonic;
  return raw.id == ARM64_INS_CMP || raw.id == ARM64_INS_CMN || raw.id == ARM64_INS_TST ||
         raw.id == ARM64_INS_CCMP || raw.id == ARM64_INS_CCMN || name.starts_with("str") ||
         name.starts_with("stp") || name.starts_with("stur");
}

void read_arm64_writes(csh handle, const cs_insn& raw, Instruction& instruction) {
  const cs_arm64& arm = raw.detail->arm64;
  if (instruction.flow == Flow::call) {
    instruction.written = ~k_arm64_kept_by_calls & 0xffffffff;
    instruction.sets_flags = true;
    return;
  }
  if (instruction.flow != Flow::next) return;
  cs_regs read, written;
  std::uint8_t reads = 0, count = 0;
  if (cs_regs_access(handle, &raw, read, &reads, written, &count) != CS_ERR_OK) {
    instruction.written = ~std::uint64_t{0};
    instruction.sets_flags = true;
    return;
  }
  instruction.sets_flags = arm.update_flags;
  for (std::uint8_t i = 0; i < count; ++i) {
    instruction.sets_flags = instruction.sets_flags || written[i] == ARM64_REG_NZCV;
    if (!arm64_only_reads(raw)) arm64_mark(instruction, arm64_register(written[i]));
  }
  for (int i = 0; i < arm.op_count; ++i) {
    const cs_arm64_op& operand = arm.operands[i];
    const bool may_be_written = i == 0 || std::string_view(raw.mnemonic).starts_with("ld");
    if (operand.type == ARM64_OP_REG && may_be_written && !arm64_only_reads(raw)) {
      arm64_mark(instruction, arm64_register(operand.reg));
    }
    if (operand.type == ARM64_OP_MEM && arm.writeback) {
      arm64_mark(instruction, arm64_register(operand.mem.base));
    }
  }
}

// A register or a constant.
std::optional<RegisterSum> arm64_value(const cs_arm64_op& operand) {
  if (operand.type == ARM64_OP_IMM) {
    const bool shifts = operand.shift.type == ARM64_SFT_LSL;
    return RegisterSum{k_no_register, shifts ? operand.imm << operand.shift.value : operand.imm,
                       false};
  }
  if (operand.type != ARM64_OP_REG || operand.shift.type != ARM64_SFT_INVALID ||
      operand.ext != ARM64_EXT_INVALID) {
    return std::nullopt;
  }
  if (operand.reg == ARM64_REG_XZR || operand.reg == ARM64_REG_WZR) return RegisterSum{};
  const Register base = arm64_register(operand.reg);
  if (base == k_no_register) return std::nullopt;
  return RegisterSum{base, 0, is_arm64_narrow(operand.reg)};
}

void read_arm64_write_back(const cs_insn& raw, Instruction& instruction) {
  const cs_arm64& arm = raw.detail->arm64;
  for (int i = 0; i < arm.op_count; ++i) {
    const cs_arm64_op& memory = arm.operands[i];
    if (memory.type != ARM64_OP_MEM || memory.mem.index != ARM64_REG_INVALID) continue;
    const bool after = i + 1 < arm.op_count;
    if (after && arm.operands[i + 1].type != ARM64_OP_IMM) return;
    const Register base = arm64_register(memory.mem.base);
    instruction.assigned = base;
    instruction.sum = {base, after ? arm.operands[i + 1].imm : memory.mem.disp, false};
  }
}

void read_arm64_sum(const cs_insn& raw, Instruction& instruction) {
  const cs_arm64& arm = raw.detail->arm64;
  if (arm.writeback) return read_arm64_write_back(raw, instruction);
  if (arm.op_count < 2 || arm.operands[0].type != ARM64_OP_REG) return;
  const Register to = arm64_register(arm.operands[0].reg);
  const bool narrow = is_arm64_narrow(arm.operands[0].reg);
  if (to == k_no_register) return;
  std::optional<RegisterSum> sum;
  if (raw.id == ARM64_INS_ADR || raw.id == ARM64_INS_ADRP) {
    sum = RegisterSum{k_load_address, arm.operands[1].imm, false};
  } else if (raw.id == ARM64_INS_MOV || raw.id == ARM64_INS_MOVZ) {
    sum = arm64_value(arm.operands[1]);
  } else if (arm.op_count == 3 && (raw.id == ARM64_INS_ADD || raw.id == ARM64_INS_SUB)) {
    const bool minus = raw.id == ARM64_INS_SUB;
    const auto right = arm64_value(arm.operands[2]);
    sum = arm64_value(arm.operands[1]);
    if (!sum || !right || right->base != k_no_register) return;
    sum->offset += minus ? -right->offset : right->offset;
  } else if (raw.id == ARM64_INS_ORR && arm.op_count == 3) {  // of the zero register: a constant
    const auto left = arm64_value(arm.operands[1]);
    if (!left || left->base != k_no_register) return;
    sum = arm64_value(arm.operands[2]);
  }
  if (!sum) return;
  instruction.assigned = to;
  instruction.sum = *sum;
  instruction.sum.narrow = narrow && sum->base != k_no_register;
  if (narrow && sum->base == k_no_register) {
    instruction.sum.offset = static_cast<std::uint32_t>(sum->offset);
  }
}

Condition arm64_condition(arm64_cc code) {
  switch (code) {
    case ARM64_CC_EQ:
      return Condition::equal;
    case ARM64_CC_NE:
      return Condition::not_equal;
    case ARM64_CC_LT:
      return Condition::less;
    case ARM64_CC_LE:
      return Condition::less_equal;
    case ARM64_CC_GT:
      return Condition::greater;
    case ARM64_CC_GE:
      return Condition::greater_equal;
    case ARM64_CC_LO:
      return Condition::below;
    case ARM64_CC_LS:
      return Condition::below_equal;
    case ARM64_CC_HI:
      return Condition::above;
    case ARM64_CC_HS:
      return Condition::above_equal;
    default:
      return Condition::unknown;
  }
}

}  // namespace

void read_arm64_effects(csh handle, const cs_insn& raw, Instruction& instruction) {
  read_arm64_writes(handle, raw, instruction);
  const cs_arm64& arm = raw.detail->arm64;
  if (instruction.flow == Flow::branch) {
    instruction.condition = arm64_condition(arm.cc);
    if (raw.id == ARM64_INS_CBZ || raw.id == ARM64_INS_CBNZ) {
      instruction.condition = raw.id == ARM64_INS_CBZ ? Condition::equal : Condition::not_equal;
      if (const auto left = arm64_value(arm.operands[0]); left) {
        instruction.compares = Comparison{*left, {}, true};
      }
    }
    return;
  }
  if (instruction.flow != Flow::next) return;
  if (raw.id == ARM64_INS_CMP && arm.op_count == 2) {
    const auto left = arm64_value(arm.operands[0]), right = arm64_value(arm.operands[1]);
    if (left && right) instruction.compares = Comparison{*left, *right, false};
    return;
  }
  read_arm64_sum(raw, instruction);
  if (arm.update_flags && instruction.assigned != k_no_register) {
    instruction.compares = Comparison{instruction.sum, {}, true};
  }
}

}  // namespace glint::prove
