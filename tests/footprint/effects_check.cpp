// Compiled with -Wfunction-effects: the compiler follows both groups' activation through the graph
// and every node down to what is declared nonblocking, and refuses what may block or allocate.
#include <cstdlib>

#include "nodes/output.hpp"
#include "nodes/tracker.hpp"

namespace glint::footprint {

void activate(Tracker& graph) noexcept [[clang::nonblocking]] { graph.activate(); }
void activate(MarkerTracker& graph) noexcept [[clang::nonblocking]] { graph.activate(); }
void activate(Output& graph) noexcept [[clang::nonblocking]] { graph.activate(); }

#ifdef GLINT_MUTANT
// What must be refused.
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
