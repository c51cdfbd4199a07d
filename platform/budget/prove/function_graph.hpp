// Control-flow graph of one function, rebuilt from its machine code: basic blocks, dominators and
// natural loops.
//
// Cost:   dominators in O(blocks^2) at worst; a function has at most k_blocks_max blocks.
// Source: Cooper, Harvey, Kennedy 2001 (dominators); Aho et al. 2006, section 9.6.6 (natural
// loops).
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "platform/budget/prove/instruction.hpp"

namespace glint::prove {

inline constexpr std::size_t k_blocks_max = 20'000;

struct Block {
  std::uint64_t address = 0;
  std::vector<Instruction> instructions;
  std::vector<int> successors;
  bool leaves = false;  // returns, traps or continues in a function that does not return
  std::optional<std::uint64_t>
      callee;           // called by the last instruction; after it a tail call leaves
  std::string library;  // or this imported or declared function
  std::vector<Instruction> uncounted;  // repeated ones whose number of repetitions is computed
  std::optional<std::int64_t> bytes;   // third argument of the last instruction's call
  std::int64_t cost = 0;               // executed instructions, without those of the callee
};

struct Loop {
  int header = 0;
  std::vector<int> blocks;              // the header first
  std::vector<int> latches;             // sources of the back edges
  int parent = -1;                      // smallest loop around it
  std::optional<std::int64_t> counted;  // jumps back of one execution, from the machine code
};

// What has no model: the address and what was found there.
struct Refusal {
  std::uint64_t address = 0;
  std::string what;
};

struct FunctionGraph {
  std::uint64_t address = 0;
  std::vector<Block> blocks;  // the entry first, then by address
  std::vector<Loop> loops;
  std::vector<Refusal> refusals;  // empty, or the graph is incomplete
};

[[nodiscard]] FunctionGraph function_graph(const ProgramCode& code, const Decoder& decoder,
                                           std::uint64_t address);

[[nodiscard]] std::vector<std::vector<int>> predecessors_of(const std::vector<Block>& blocks);

// Immediate dominator of each block; that of the entry is itself.
[[nodiscard]] std::vector<int> dominators(const std::vector<Block>& blocks);

[[nodiscard]] bool dominates(const std::vector<int>& immediate, int above, int below);

// Sets `loops`; a cycle whose header does not dominate it is a refusal.
void find_loops(FunctionGraph& graph);

}  // namespace glint::prove
