// Proof of a kernel's largest instruction count: from a program's machine code to a certificate.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "platform/budget/prove/call_graph.hpp"
#include "platform/budget/prove/certificate.hpp"
#include "platform/budget/prove/loop_bounds.hpp"
#include "platform/budget/prove/path_graph.hpp"
#include "platform/budget/prove/program_code.hpp"
#include "platform/budget/prove/source_lines.hpp"

namespace glint::prove {

// A kernel, and its loops' worst counts under the limits of a cell.
struct KernelCounts {
  std::string kernel;
  NamedCounts worst;
};

struct LoopFinding {
  std::uint64_t address = 0;
  std::string place;  // of a jump back, or the entry's line
  std::string function;
  std::optional<std::int64_t> at_most;  // nothing: unknown
};

struct HeavyBlock {
  std::uint64_t address = 0;
  std::string function, place;
  double runs = 0;          // on a longest path
  double instructions = 0;  // of all its runs
};

struct KernelProof {
  std::string kernel, function, root;  // the function that the bound covers; root: demangled
  std::vector<std::string> reasons;    // why it is not proved; empty: proved
  std::vector<std::string> declared;   // library functions with a declared cost
  std::vector<LoopFinding> loops;
  std::vector<HeavyBlock> heaviest;  // largest first
  PathGraph graph;
  Certificate certificate;
  bool tight = false;  // a path of exactly this cost exists in the graph
  std::string graph_text, certificate_text;

  [[nodiscard]] bool proved() const { return reasons.empty(); }
};

class Prover {
 public:
  // `lines`: a program of the same code that has a line table; it may be `program` itself.
  Prover(const std::string& program, const std::string& lines, const LoopBounds& bounds,
         const NamedCounts& limits);

  // `folder`: of the solver's files.
  [[nodiscard]] KernelProof prove(const KernelCounts& kernel, const std::string& folder) const;
  [[nodiscard]] const ProgramCode& code() const { return code_; }

 private:
  [[nodiscard]] std::string place_of(std::uint64_t address) const;
  void add_loops(const CallGraph& calls, const KernelCounts& kernel, KernelProof& proof) const;
  void add_calls(const CallGraph& calls, const KernelCounts& kernel, KernelProof& proof) const;
  void add_library_costs(const CallGraph& calls, KernelProof& proof) const;
  void check_same_code(const CallGraph& calls, KernelProof& proof) const;
  void find_heaviest(const PathSolution& solution, KernelProof& proof) const;

  ProgramCode code_, lines_code_;
  SourceLines lines_;
  const LoopBounds& bounds_;
  NamedCounts limits_;
};

}  // namespace glint::prove
