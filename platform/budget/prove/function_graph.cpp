#include "platform/budget/prove/function_graph.hpp"

#include <algorithm>
#include <map>
#include <set>

#include "platform/budget/prove/callee.hpp"
#include "platform/budget/prove/cleared_words.hpp"

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
    count_costs();
    if (graph_.refusals.empty()) find_loops(graph_);
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

  // Constant that a register has before an instruction: from the last write of it in this block, or
  // in the blocks that alone lead here.
  std::optional<std::int64_t> constant_before(std::size_t block, std::size_t instruction,
                                              RegisterWrite Instruction::*of_register) const {
    for (std::size_t steps = 0; steps < k_blocks_max; ++steps) {
      const std::vector<Instruction>& all = graph_.blocks[block].instructions;
      while (instruction-- > 0) {
        if (all[instruction].flow == Flow::call) return std::nullopt;  // the callee may write it
        const RegisterWrite& write = all[instruction].*of_register;
        if (write.written) return write.constant;
      }
      if (block == 0 || only_predecessor_[block] < 0) return std::nullopt;
      block = static_cast<std::size_t>(only_predecessor_[block]);
      instruction = graph_.blocks[block].instructions.size();
    }
    return std::nullopt;
  }

  void find_only_predecessors() {
    constexpr int k_none = -1, k_several = -2;
    only_predecessor_.assign(graph_.blocks.size(), k_none);
    for (std::size_t from = 0; from < graph_.blocks.size(); ++from) {
      for (const int to : graph_.blocks[from].successors) {
        int& only = only_predecessor_[static_cast<std::size_t>(to)];
        only = only == k_none ? static_cast<int>(from) : k_several;
      }
    }
  }

  void count_costs() {
    find_only_predecessors();
    for (std::size_t number = 0; number < graph_.blocks.size(); ++number) {
      Block& block = graph_.blocks[number];
      block.cost = static_cast<std::int64_t>(block.instructions.size());
      for (std::size_t i = 0; i < block.instructions.size(); ++i) {
        if (!block.instructions[i].repeats) continue;
        auto count = constant_before(number, i, &Instruction::repetitions);
        if (!count) count = words_cleared(block.instructions, i);
        if (!count || *count < 0) block.uncounted.push_back(block.instructions[i]);
        block.cost += count.value_or(0);
      }
      if (block.library.empty()) continue;
      block.bytes =
          constant_before(number, block.instructions.size() - 1, &Instruction::third_argument);
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
  std::vector<int> only_predecessor_;  // negative: none or several
  std::set<std::uint64_t> leaders_;
  std::vector<std::uint64_t> open_;
};

}  // namespace

FunctionGraph function_graph(const ProgramCode& code, const Decoder& decoder,
                             std::uint64_t address) {
  return Builder(code, decoder, address).build();
}

}  // namespace glint::prove
