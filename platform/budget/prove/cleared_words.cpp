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

}  // namespace

std::optional<std::int64_t> words_cleared(const std::vector<Block>& blocks, int block,
                                          std::size_t repeat, const RegisterValues& values) {
  const std::vector<Instruction>& all = blocks[static_cast<std::size_t>(block)].instructions;
  const std::size_t shift = last_write(all, repeat, k_rcx);
  if (shift == repeat || all[shift].text != "shr ecx, 3") return std::nullopt;
  const RegisterValue left = values.before({k_rcx, 0, false}, block, shift);
  const auto subtract = static_cast<std::size_t>(left.place & 0xffffffff);
  if (left.origin != Origin::written || left.place >> 32 != static_cast<std::uint64_t>(block) ||
      subtract >= shift) {
    return std::nullopt;
  }
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
