#include "platform/budget/prove/register_values.hpp"

namespace glint::prove {
namespace {

constexpr int k_merges_max = 3;  // of paths with one constant
constexpr std::int64_t k_offset_max = std::int64_t{1} << 48;
constexpr std::int64_t k_narrow_max = std::int64_t{1} << 31;

}  // namespace

RegisterValues::RegisterValues(const std::vector<Block>& blocks)
    : blocks_(blocks),
      immediate_(dominators(blocks)),
      before_(predecessors_of(blocks)),
      written_(blocks.size(), 0) {
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    for (const Instruction& one : blocks[i].instructions) written_[i] |= one.written;
  }
}

// Registers that can change between the end of the block's dominator and its start.
std::uint64_t RegisterValues::written_between(int block) const {
  const auto found = between_.find(block);
  if (found != between_.end()) return found->second;
  const int dominator = immediate_[static_cast<std::size_t>(block)];
  std::vector<bool> seen(blocks_.size(), false);
  std::uint64_t written = 0;
  std::vector<int> open = predecessors(block);
  while (!open.empty()) {
    const int at = open.back();
    open.pop_back();
    if (at == dominator || seen[static_cast<std::size_t>(at)]) continue;
    seen[static_cast<std::size_t>(at)] = true;
    written |= written_[static_cast<std::size_t>(at)];
    for (const int from : predecessors(at)) open.push_back(from);
  }
  return between_[block] = written;
}

RegisterValue RegisterValues::at_end(Register of, int block, int start) const {
  return before({of, 0, false}, block, blocks_[static_cast<std::size_t>(block)].instructions.size(),
                start);
}

// The constant that a register has at the end of each predecessor.
std::optional<std::int64_t> RegisterValues::same_constant(Register of, int block, int start,
                                                          int depth) const {
  if (depth == 0 || predecessors(block).empty()) return std::nullopt;
  std::optional<std::int64_t> same;
  for (const int from : predecessors(block)) {
    const std::size_t end = blocks_[static_cast<std::size_t>(from)].instructions.size();
    const RegisterValue value = traced({of, 0, false}, from, end, start, depth - 1);
    if (value.origin != Origin::none || (same && *same != value.offset)) return std::nullopt;
    same = value.offset;
  }
  return same;
}

RegisterValue RegisterValues::before(const RegisterSum& sum, int block, std::size_t index,
                                     int start) const {
  return traced(sum, block, index, start, k_merges_max);
}

RegisterValue RegisterValues::traced(const RegisterSum& sum, int block, std::size_t index,
                                     int start, int depth) const {
  RegisterValue value;
  value.offset = sum.offset;
  value.base = sum.base;
  const auto ends_at = [&](Origin origin, std::uint64_t place) {
    value.origin = origin;
    value.place = place;
    return value;
  };
  for (;;) {
    if (value.base == k_no_register) return ends_at(Origin::none, 0);
    if (value.base == k_load_address) return ends_at(Origin::loaded, 0);
    const std::vector<Instruction>& all = blocks_[static_cast<std::size_t>(block)].instructions;
    while (index > 0 && !all[index - 1].writes(value.base)) --index;
    if (index > 0) {
      const Instruction& write = all[--index];
      const std::int64_t offset = value.offset + write.sum.offset;
      if (write.assigned != value.base || offset > k_offset_max || offset < -k_offset_max) {
        return ends_at(Origin::written, static_cast<std::uint64_t>(block) << 32 | index);
      }
      // A constant survives 32-bit steps only where they cannot wrap around.
      if (write.sum.base == k_no_register && value.narrow &&
          (offset < 0 || offset >= k_narrow_max)) {
        return ends_at(Origin::written, static_cast<std::uint64_t>(block) << 32 | index);
      }
      value.base = write.sum.base;
      value.offset = offset;
      value.narrow = value.narrow || write.sum.narrow;
      continue;
    }
    if (block == start) return ends_at(Origin::start, 0);
    if (immediate_[static_cast<std::size_t>(block)] < 0 ||
        (written_between(block) >> value.base & 1) != 0) {
      const std::optional<std::int64_t> constant = same_constant(value.base, block, start, depth);
      if (!constant || value.narrow) {
        return ends_at(Origin::combined, static_cast<std::uint64_t>(block));
      }
      value.offset += *constant;
      value.base = k_no_register;
      return ends_at(Origin::none, 0);
    }
    block = immediate_[static_cast<std::size_t>(block)];
    index = blocks_[static_cast<std::size_t>(block)].instructions.size();
  }
}

}  // namespace glint::prove
