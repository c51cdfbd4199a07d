#include "platform/budget/expected_board.hpp"

#include <cstdio>

#include "glint_build_signature.hpp"
#include "nodes/mapper.hpp"
#include "nodes/output.hpp"
#include "nodes/tracker.hpp"

namespace glint {

std::string signature_text(std::uint64_t signature) {
  char digits[32];
  std::snprintf(digits, sizeof digits, "0x%016llx", static_cast<unsigned long long>(signature));
  return digits;
}

BoardExpectation expected_board() {
  BoardExpectation expected;
  expected.build = k_build_signature;
  expected.graphs = {{"Tracker", signature_text(graph::Description<Tracker>::signature)},
                     {"Output", signature_text(graph::Description<Output>::signature)}};
  for (const KernelLoops& kernel : kernels_of<Tracker, Output>) {
    expected.kernels.push_back(kernel);
  }
  BoardExpectation::Optional background;
  background.graph = {"Background", signature_text(graph::Description<Background>::signature)};
  for (const KernelLoops& kernel : kernels_of<Background>) background.kernels.push_back(kernel);
  expected.optional.push_back(background);
  return expected;
}

}  // namespace glint
