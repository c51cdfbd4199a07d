#include "platform/budget/prove/cleared_words.hpp"

#include <string>

namespace glint::prove {
namespace {

constexpr Register k_rcx = 1, k_rdi = 7;
constexpr std::int64_t k_bytes_max = std::int64_t{1} << 31;  // the sums are of 32 bits

// Last instruction before `end` that writes the register; `end` if there is none.
std::size_t last_write(const std::vector<Instruction>& all, std::size_t end, Register of) {
  for (std::size_t i = end; i-- > 0;) {
    if (all[i].writes(of)) return i;
  }
  return end;
}

bool is_written_in(const RegisterValue& value, int block) {
  return value.origin == Origin::written && value.place >> 32 == static_cast<std::uint64_t>(block);
}

}  // namespace

std::optional<std::int64_t> words_cleared(const std::vector<Block>& blocks, int block,
                                          std::size_t repeat, const RegisterValues& values) {
  const std::vector<Instruction>& all = blocks[static_cast<std::size_t>(block)].instructions;
  const RegisterValue count = values.before({k_rcx, 0, false}, block, repeat);
  const auto shift = static_cast<std::size_t>(count.place & 0xffffffff);
  if (!is_written_in(count, block) || count.offset != 0 || shift >= repeat ||
      !all[shift].text.starts_with("shr e") || !all[shift].text.ends_with(", 3")) {
    return std::nullopt;
  }
  const RegisterValue left = values.before({count.base, 0, false}, block, shift);
  const auto subtract = static_cast<std::size_t>(left.place & 0xffffffff);
  if (!is_written_in(left, block) || subtract >= shift) return std::nullopt;
  const std::string& text = all[subtract].text;
  const std::size_t align = last_write(all, subtract, k_rdi);
  if (!text.starts_with("sub ") || !(text.ends_with(", rdi") || text.ends_with(", edi")) ||
      align == subtract || all[align].text != "and rdi, 0xfffffffffffffff8") {
    return std::nullopt;
  }
  const RegisterValue start = values.before({left.base, 0, false}, block, subtract),
                      unaligned = values.before({k_rdi, 0, false}, block, align);
  const std::int64_t bytes = left.offset + start.offset - unaligned.offset + 7;
  if (!start.same_origin(unaligned) || bytes < 7 || bytes > k_bytes_max) return std::nullopt;
  return bytes / 8;
}

}  // namespace glint::prove
