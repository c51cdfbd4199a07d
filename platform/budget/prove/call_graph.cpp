#include "platform/budget/prove/call_graph.hpp"

#include <algorithm>
#include <map>

#include "platform/sinks/record/sha256.hpp"

namespace glint::prove {
namespace {

class CallOrder {
 public:
  explicit CallOrder(const ProgramCode& code) : code_(code), decoder_(code) {}

  void visit(std::uint64_t address) {
    state_[address] = State::open;
    FunctionGraph graph = function_graph(code_, decoder_, address);
    for (const Block& block : graph.blocks) {
      if (!block.callee) continue;
      const auto found = state_.find(*block.callee);
      if (found == state_.end()) {
        if (state_.size() >= k_functions_max) {
          calls_.refusals.push_back({address, "more than 2000 functions"});
          return;
        }
        visit(*block.callee);
      } else if (found->second == State::open) {
        calls_.refusals.push_back(
            {block.instructions.back().address, "recursion into " + code_.text_of(*block.callee)});
      }
    }
    state_[address] = State::done;
    calls_.functions.push_back(std::move(graph));
  }
  CallGraph result() { return std::move(calls_); }

 private:
  enum class State : std::uint8_t { open, done };
  const ProgramCode& code_;
  Decoder decoder_;
  std::map<std::uint64_t, State> state_;
  CallGraph calls_;
};

}  // namespace

int CallGraph::index_of(std::uint64_t address) const {
  const auto found = std::find_if(functions.begin(), functions.end(),
                                  [&](const FunctionGraph& one) { return one.address == address; });
  return found == functions.end() ? -1 : static_cast<int>(found - functions.begin());
}

CallGraph call_graph(const ProgramCode& code, std::uint64_t root) {
  CallOrder order(code);
  order.visit(root);
  return order.result();
}

std::string code_sha256(const ProgramCode& code, const CallGraph& calls) {
  std::map<std::uint64_t, int> sizes;
  for (const FunctionGraph& function : calls.functions) {
    for (const Block& block : function.blocks) {
      for (const Instruction& one : block.instructions) sizes[one.address] = one.size;
    }
  }
  Sha256 hash;
  for (const auto& [address, size] : sizes) {
    hash.add(code.bytes_at(address).first(static_cast<std::size_t>(size)));
  }
  return hash.hex();
}

}  // namespace glint::prove
