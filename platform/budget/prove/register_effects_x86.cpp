#include <array>

#include "platform/budget/prove/register_effects.hpp"

namespace glint::prove {
namespace {

// rbx, rsp, rbp, r12 to r15: System V ABI, x86-64 supplement, figure 3.4.
constexpr std::uint64_t k_x86_kept_by_calls = 0xf038;
constexpr Register k_rsp = 4;

struct X86Names {
  std::array<unsigned, 5> ids;  // unused places are 0, no register
};
constexpr std::array<X86Names, 16> k_x86_registers = {{
    {{X86_REG_RAX, X86_REG_EAX, X86_REG_AX, X86_REG_AL, X86_REG_AH}},
    {{X86_REG_RCX, X86_REG_ECX, X86_REG_CX, X86_REG_CL, X86_REG_CH}},
    {{X86_REG_RDX, X86_REG_EDX, X86_REG_DX, X86_REG_DL, X86_REG_DH}},
    {{X86_REG_RBX, X86_REG_EBX, X86_REG_BX, X86_REG_BL, X86_REG_BH}},
    {{X86_REG_RSP, X86_REG_ESP, X86_REG_SP, X86_REG_SPL, 0}},
    {{X86_REG_RBP, X86_REG_EBP, X86_REG_BP, X86_REG_BPL, 0}},
    {{X86_REG_RSI, X86_REG_ESI, X86_REG_SI, X86_REG_SIL, 0}},
    {{X86_REG_RDI, X86_REG_EDI, X86_REG_DI, X86_REG_DIL, 0}},
    {{X86_REG_R8, X86_REG_R8D, X86_REG_R8W, X86_REG_R8B, 0}},
    {{X86_REG_R9, X86_REG_R9D, X86_REG_R9W, X86_REG_R9B, 0}},
    {{X86_REG_R10, X86_REG_R10D, X86_REG_R10W, X86_REG_R10B, 0}},
    {{X86_REG_R11, X86_REG_R11D, X86_REG_R11W, X86_REG_R11B, 0}},
    {{X86_REG_R12, X86_REG_R12D, X86_REG_R12W, X86_REG_R12B, 0}},
    {{X86_REG_R13, X86_REG_R13D, X86_REG_R13W, X86_REG_R13B, 0}},
    {{X86_REG_R14, X86_REG_R14D, X86_REG_R14W, X86_REG_R14B, 0}},
    {{X86_REG_R15, X86_REG_R15D, X86_REG_R15W, X86_REG_R15B, 0}},
}};

Register x86_register(unsigned id) {
  for (std::size_t number = 0; number < k_x86_registers.size() && id != 0; ++number) {
    for (const unsigned name : k_x86_registers[number].ids) {
      if (name == id) return static_cast<Register>(number);
    }
  }
  return k_no_register;
}

void x86_mark(Instruction& instruction, Register number) {
  if (number != k_no_register) instruction.written |= std::uint64_t{1} << number;
}

void read_x86_writes(csh handle, const cs_insn& raw, Instruction& instruction) {
  const cs_x86& x86 = raw.detail->x86;
  cs_regs read, written;
  std::uint8_t reads = 0, count = 0;
  if (cs_regs_access(handle, &raw, read, &reads, written, &count) != CS_ERR_OK) {
    instruction.written = ~std::uint64_t{0};
    instruction.sets_flags = true;
    return;
  }
  for (std::uint8_t i = 0; i < count; ++i) {
    x86_mark(instruction, x86_register(written[i]));
    instruction.sets_flags = instruction.sets_flags || written[i] == X86_REG_EFLAGS;
  }
  const bool only_reads = raw.id == X86_INS_CMP || raw.id == X86_INS_TEST ||
                          raw.id == X86_INS_PUSH || instruction.flow != Flow::next;
  if (!only_reads && x86.op_count > 0 && x86.operands[0].type == X86_OP_REG) {
    x86_mark(instruction, x86_register(x86.operands[0].reg));
  }
  if (instruction.flow == Flow::call) {
    instruction.written = (instruction.written | ~k_x86_kept_by_calls) & 0xffff & ~(1u << k_rsp);
    instruction.sets_flags = true;
  }
}

// A register or a constant, of 32 or 64 bits.
std::optional<RegisterSum> x86_value(const cs_x86_op& operand) {
  RegisterSum sum;
  if (operand.size < 4) return std::nullopt;
  sum.narrow = operand.size == 4;
  if (operand.type == X86_OP_IMM) {
    sum.offset = operand.imm;
    return sum;
  }
  if (operand.type != X86_OP_REG) return std::nullopt;
  sum.base = x86_register(operand.reg);
  if (sum.base == k_no_register) return std::nullopt;
  return sum;
}

std::optional<RegisterSum> x86_address(const cs_x86_op& operand, const Instruction& instruction) {
  if (operand.mem.index != X86_REG_INVALID) return std::nullopt;
  RegisterSum sum{x86_register(operand.mem.base), operand.mem.disp, false};
  if (operand.mem.base == X86_REG_RIP) {
    sum = {k_load_address, static_cast<std::int64_t>(instruction.end()) + operand.mem.disp, false};
  }
  if (sum.base == k_no_register) return std::nullopt;
  return sum;
}

std::optional<RegisterSum> x86_sum(const cs_insn& raw, const Instruction& instruction) {
  const cs_x86& x86 = raw.detail->x86;
  const cs_x86_op& to = x86.operands[0];
  if (to.size < 4) return std::nullopt;
  const bool narrow = to.size == 4;
  if (raw.id == X86_INS_LEA) {
    std::optional<RegisterSum> sum = x86_address(x86.operands[1], instruction);
    if (sum) sum->narrow = narrow;
    return sum;
  }
  if (raw.id == X86_INS_INC) return RegisterSum{x86_register(to.reg), 1, narrow};
  if (raw.id == X86_INS_DEC) return RegisterSum{x86_register(to.reg), -1, narrow};
  if (x86.op_count != 2) return std::nullopt;
  const cs_x86_op& from = x86.operands[1];
  const bool same = from.type == X86_OP_REG && from.reg == to.reg;
  if ((raw.id == X86_INS_XOR || raw.id == X86_INS_SUB) && same) return RegisterSum{};
  if (raw.id == X86_INS_MOV || raw.id == X86_INS_MOVABS) {
    std::optional<RegisterSum> sum = x86_value(from);
    if (sum && narrow && sum->base == k_no_register) {
      sum->offset = static_cast<std::uint32_t>(sum->offset);
      sum->narrow = false;
    }
    return sum;
  }
  if (from.type != X86_OP_IMM) return std::nullopt;
  if (raw.id == X86_INS_ADD) return RegisterSum{x86_register(to.reg), from.imm, narrow};
  if (raw.id == X86_INS_SUB) return RegisterSum{x86_register(to.reg), -from.imm, narrow};
  return std::nullopt;
}

Condition x86_condition(unsigned id) {
  switch (id) {
    case X86_INS_JE:
      return Condition::equal;
    case X86_INS_JNE:
      return Condition::not_equal;
    case X86_INS_JL:
      return Condition::less;
    case X86_INS_JLE:
      return Condition::less_equal;
    case X86_INS_JG:
      return Condition::greater;
    case X86_INS_JGE:
      return Condition::greater_equal;
    case X86_INS_JB:
      return Condition::below;
    case X86_INS_JBE:
      return Condition::below_equal;
    case X86_INS_JA:
      return Condition::above;
    case X86_INS_JAE:
      return Condition::above_equal;
    default:
      return Condition::unknown;
  }
}

}  // namespace

void read_x86_effects(csh handle, const cs_insn& raw, Instruction& instruction) {
  read_x86_writes(handle, raw, instruction);
  const cs_x86& x86 = raw.detail->x86;
  if (instruction.flow == Flow::branch) instruction.condition = x86_condition(raw.id);
  if (instruction.flow != Flow::next || x86.op_count == 0) return;
  if (x86.operands[0].type == X86_OP_REG && raw.id != X86_INS_CMP && raw.id != X86_INS_TEST) {
    if (const auto sum = x86_sum(raw, instruction); sum) {
      instruction.assigned = x86_register(x86.operands[0].reg);
      instruction.sum = *sum;
    }
  }
  if (!instruction.sets_flags || x86.op_count > 2) return;
  if (raw.id == X86_INS_CMP || raw.id == X86_INS_TEST) {
    const auto left = x86_value(x86.operands[0]), right = x86_value(x86.operands[1]);
    if (!left || !right) return;
    if (raw.id == X86_INS_CMP) instruction.compares = Comparison{*left, *right, false};
    if (raw.id == X86_INS_TEST && left->base != k_no_register && left->base == right->base) {
      instruction.compares = Comparison{*left, {}, true};
    }
  } else if (instruction.assigned != k_no_register) {
    instruction.compares = Comparison{instruction.sum, {}, true};
  }
}

}  // namespace glint::prove
