#include "platform/budget/prove/proved_code.hpp"

#include "platform/budget/prove/call_graph.hpp"
#include "platform/input_error.hpp"

namespace glint::prove {

ProvedBounds bounds_of_program(const ProofFile& proofs, const std::string& program) {
  const ProgramCode code(program);
  if (name_of(code.machine()) != proofs.machine) {
    throw InputError(program + ": a program of " + name_of(code.machine()) +
                     "; expected one of the proofs' machine, " + proofs.machine);
  }
  ProvedBounds bounds;
  bounds.limits = proofs.limits;
  for (const ProvedKernel& proved : proofs.kernels) {
    const auto roots = code.functions_named(proved.root);
    if (roots.size() != 1) {
      bounds.refused[proved.kernel] = "the program has no function " + short_name(proved.root);
    } else if (code_sha256(code, call_graph(code, roots.front()->address)) != proved.code_sha256) {
      bounds.refused[proved.kernel] = "the program has other machine code than the proof";
    } else {
      bounds.instructions[proved.kernel] = proved.instructions;
    }
  }
  return bounds;
}

}  // namespace glint::prove
