#include "platform/budget/prove/cleared_words.hpp"

#include <array>
#include <cstdlib>
#include <string_view>

namespace glint::prove {
namespace {

// "rdi" of "add rdi, 8"
std::string first_operand(const Instruction& instruction) {
  const std::size_t space = instruction.text.find(' ');
  if (space == std::string::npos) return "";
  const std::size_t comma = instruction.text.find(',', space);
  return instruction.text.substr(space + 1, comma - space - 1);
}

// Last instruction of this text before `end`; `end` if there is none, or if a later one writes its
// first operand.
std::size_t last_write(const std::vector<Instruction>& block, std::size_t end,
                       const std::string& text) {
  const std::string written = text.substr(text.find(' ') + 1, text.find(',') - text.find(' ') - 1);
  for (std::size_t i = end; i-- > 0;) {
    if (block[i].flow == Flow::call) return end;
    if (block[i].text == text) return i;
    if (first_operand(block[i]) == written) return end;
  }
  return end;
}

}  // namespace

std::optional<std::int64_t> words_cleared(const std::vector<Instruction>& block,
                                          std::size_t repeat) {
  std::array<std::size_t, 4> count_writes{};  // the last four writes of rcx, backwards
  std::size_t found = 0;
  for (std::size_t i = repeat; i-- > 0 && found < count_writes.size();) {
    if (block[i].flow == Flow::call) return std::nullopt;
    if (block[i].repetitions.written) count_writes[found++] = i;
  }
  if (found < count_writes.size()) return std::nullopt;
  const auto [shift, add, subtract, copy] = count_writes;
  constexpr std::string_view k_copy = "mov rcx, ", k_add = "add ecx, ";
  if (block[shift].text != "shr ecx, 3" || !block[add].text.starts_with(k_add) ||
      block[subtract].text != "sub rcx, rdi" || !block[copy].text.starts_with(k_copy)) {
    return std::nullopt;
  }
  const std::string start = block[copy].text.substr(k_copy.size());
  const std::size_t align = last_write(block, subtract, "and rdi, 0xfffffffffffffff8");
  if (align == subtract) return std::nullopt;
  std::size_t advance = last_write(block, align, "lea rdi, [" + start + " + 8]");
  if (advance == align) {
    advance = last_write(block, align, "add rdi, 8");
    if (advance == align) return std::nullopt;
    // rdi is the start: neither changes between its copy and the advance.
    const std::size_t copied = last_write(block, advance, "mov " + start + ", rdi");
    if (copied == advance) return std::nullopt;
    for (std::size_t i = copied + 1; i < advance; ++i) {
      if (first_operand(block[i]) == "rdi") return std::nullopt;
    }
  }
  for (std::size_t i = advance + 1; i < copy; ++i) {
    if (first_operand(block[i]) == start) return std::nullopt;
  }
  char* end = nullptr;
  const std::int64_t bytes = std::strtoll(block[add].text.c_str() + k_add.size(), &end, 0);
  if (*end != '\0' || bytes <= 0) return std::nullopt;
  return bytes / 8;
}

}  // namespace glint::prove
