// All functions that a kernel's function can call, callees before their callers.
#pragma once

#include <string>
#include <vector>

#include "platform/budget/prove/function_graph.hpp"

namespace glint::prove {

inline constexpr std::size_t k_functions_max = 2'000;

struct CallGraph {
  std::vector<FunctionGraph> functions;  // the root is the last one
  std::vector<Refusal> refusals;         // recursion, too many functions

  [[nodiscard]] int index_of(std::uint64_t address) const;
};

[[nodiscard]] CallGraph call_graph(const ProgramCode& code, std::uint64_t root);

// SHA-256 of the bytes of all their instructions, in the order of the addresses.
[[nodiscard]] std::string code_sha256(const ProgramCode& code, const CallGraph& calls);

}  // namespace glint::prove
