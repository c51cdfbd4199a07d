// Compile-time check with -Wfunction-effects. The compiler follows the activation of both groups
// through the graph and every node to functions declared nonblocking, and rejects blocking or
// allocation.
#include <cstdlib>

#include "nodes/output.hpp"
#include "nodes/tracker.hpp"

namespace glint::footprint {

void activate(Tracker& graph) noexcept [[clang::nonblocking]] { graph.activate(); }
void activate(MarkerTracker& graph) noexcept [[clang::nonblocking]] { graph.activate(); }
void activate(Output& graph) noexcept [[clang::nonblocking]] { graph.activate(); }

#ifdef GLINT_MUTANT
// A node that must be rejected.
struct AllocatingNode {
  void operator()(const Now& now, PoseSamples& samples) const noexcept {
    samples.count = std::malloc(64) != nullptr && now.number > 0 ? 1 : 0;
  }
};
void activate(
    graph::Graph<graph::Inputs<Now>, graph::Outputs<PoseSamples>, AllocatingNode>& graph) noexcept
    [[clang::nonblocking]] {
  graph.activate();
}
#endif

}  // namespace glint::footprint
