#include "platform/budget/prove/function_graph.hpp"

#include <algorithm>
#include <map>
#include <set>

#include "platform/budget/prove/callee.hpp"
#include "platform/budget/prove/cleared_words.hpp"
#include "platform/budget/prove/counted_loops.hpp"
#include "platform/budget/prove/register_values.hpp"
#include "platform/budget/prove/shared_cycles.hpp"

namespace glint::prove {
namespace {

class Builder {
 public:
  Builder(const ProgramCode& code, const Decoder& decoder, std::uint64_t entry)
      : code_(code), decoder_(decoder) {
    graph_.address = entry;
    leaders_.insert(entry);
    open_ = {entry};
  }

  FunctionGraph build() {
    while (!open_.empty() && instructions_.size() < 64 * k_blocks_max) {
      const std::uint64_t address = open_.back();
      open_.pop_back();
      follow(address);
    }
    if (leaders_.size() > k_blocks_max || !open_.empty()) refuse(graph_.address, "too many blocks");
    split();
    if (!split_shared_cycles(graph_.blocks)) refuse(graph_.address, "cycles with many entries");
    const RegisterValues values(graph_.blocks);
    count_costs(values);
    if (graph_.refusals.empty()) find_loops(graph_);
    for (Loop& loop : graph_.loops) loop.counted = counted_jumps_back(graph_, loop, values);
    return std::move(graph_);
  }

 private:
  void refuse(std::uint64_t address, const std::string& what) {
    graph_.refusals.push_back({address, what});
  }

  // Another function, reached by a jump: a tail call. Parts that a compiler moved away are none.
  [[nodiscard]] bool is_other_function(std::uint64_t target) const {
    return target != graph_.address && code_.function_at(target) != nullptr;
  }

  void lead(std::uint64_t address) {
    if (leaders_.insert(address).second) open_.push_back(address);
  }

  void follow(std::uint64_t address) {
    while (!instructions_.contains(address)) {
      const std::optional<Instruction> found = decoder_.at(address);
      if (!found) return refuse(address, "an instruction without a model");
      const Instruction& instruction = instructions_[address] = *found;
      address = instruction.end();
      switch (instruction.flow) {
        case Flow::next:
          break;
        case Flow::returns:
        case Flow::stops:
          return;
        case Flow::jump:
          return follow_jump(instruction);
        case Flow::branch:
          if (!instruction.target) return refuse(instruction.address, "a branch without a target");
          if (!is_other_function(*instruction.target)) lead(*instruction.target);
          lead(address);
          return;
        case Flow::call:
          if (!does_not_return(code_, decoder_, instruction)) lead(address);
          return;
      }
    }
    leaders_.insert(address);
  }

  void follow_jump(const Instruction& jump) {
    if (jump.target) {
      if (!is_other_function(*jump.target) && !stub_slot(code_, decoder_, *jump.target)) {
        lead(*jump.target);
      }
      return;
    }
    if (!jump.slot) refuse(jump.address, "an indirect jump (switch table): " + jump.text);
  }

  void split() {
    std::map<std::uint64_t, int> index;
    index[graph_.address] = 0;
    int count = 1;
    for (const std::uint64_t leader : leaders_) {
      if (leader != graph_.address && instructions_.contains(leader)) index[leader] = count++;
    }
    graph_.blocks.resize(static_cast<std::size_t>(count));
    for (const auto& [address, number] : index) {
      Block& block = graph_.blocks[static_cast<std::size_t>(number)];
      block.address = address;
      for (auto at = instructions_.find(address); at != instructions_.end();
           at = instructions_.find(at->second.end())) {
        if (at->first != address && index.contains(at->first)) break;
        block.instructions.push_back(at->second);
        if (at->second.flow != Flow::next) break;
      }
      finish(block, index);
    }
  }

  void count_costs(const RegisterValues& values) {
    const bool x86 = code_.machine() == Machine::x86_64;
    const Register count_register = 1, third_argument = 2;  // rcx; rdx and x2
    const auto constant = [&](Register of, std::size_t number,
                              std::size_t index) -> std::optional<std::int64_t> {
      const RegisterValue value = values.before({of, 0, false}, static_cast<int>(number), index);
      if (value.origin != Origin::none || value.offset < 0) return std::nullopt;
      return value.offset;
    };
    for (std::size_t number = 0; number < graph_.blocks.size(); ++number) {
      Block& block = graph_.blocks[number];
      block.cost = static_cast<std::int64_t>(block.instructions.size());
      for (std::size_t i = 0; x86 && i < block.instructions.size(); ++i) {
        if (!block.instructions[i].repeats) continue;
        auto count = constant(count_register, number, i);
        if (!count) count = words_cleared(graph_.blocks, static_cast<int>(number), i, values);
        if (!count) block.uncounted.push_back(block.instructions[i]);
        block.cost += count.value_or(0);
      }
      if (block.library.empty()) continue;
      block.bytes = constant(third_argument, number, block.instructions.size() - 1);
    }
  }

  void finish(Block& block, const std::map<std::uint64_t, int>& index) {
    const auto goes_to = [&](std::uint64_t address) {
      const auto found = index.find(address);
      if (found == index.end()) return;
      auto& to = block.successors;
      if (std::find(to.begin(), to.end(), found->second) == to.end()) to.push_back(found->second);
    };
    if (block.instructions.empty()) return;  // its address has been refused
    const Instruction& last = block.instructions.back();
    switch (last.flow) {
      case Flow::next:
        goes_to(last.end());
        break;
      case Flow::returns:
      case Flow::stops:
        block.leaves = true;
        break;
      case Flow::branch:
        if (last.target && is_other_function(*last.target)) {
          refuse(last.address, "a conditional jump to another function");
        } else if (last.target) {
          goes_to(*last.target);
        }
        goes_to(last.end());
        break;
      case Flow::jump:
        finish_jump(block, last, goes_to);
        break;
      case Flow::call:
        name_callee(block, last);
        block.leaves = does_not_return(code_, decoder_, last);
        if (!block.leaves) goes_to(last.end());
        break;
    }
  }

  template <class GoesTo>
  void finish_jump(Block& block, const Instruction& last, const GoesTo& goes_to) {
    if (last.target && index_of_own(*last.target)) {
      goes_to(*last.target);
    } else {
      name_callee(block, last);
      block.leaves = true;
    }
  }
  [[nodiscard]] bool index_of_own(std::uint64_t target) const {
    return leaders_.contains(target) && !is_other_function(target);
  }

  void name_callee(Block& block, const Instruction& last) {
    const Callee callee = callee_of(code_, decoder_, last);
    if (!callee.library.empty()) {
      block.library = callee.library;
    } else if (callee.address) {
      block.callee = callee.address;
    } else if (last.flow == Flow::call || last.slot) {
      refuse(last.address, "an indirect call: " + last.text);
    }
  }

  const ProgramCode& code_;
  const Decoder& decoder_;
  FunctionGraph graph_;
  std::map<std::uint64_t, Instruction> instructions_;
  std::set<std::uint64_t> leaders_;
  std::vector<std::uint64_t> open_;
};

}  // namespace

FunctionGraph function_graph(const ProgramCode& code, const Decoder& decoder,
                             std::uint64_t address) {
  return Builder(code, decoder, address).build();
}

}  // namespace glint::prove
