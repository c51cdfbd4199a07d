// Runs both groups under RealtimeSanitizer: a blocking call or allocation in a nonblocking function
// ends the program. The argument `allocate` enables the mutant.
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "tests/footprint/groups.hpp"

namespace glint::footprint {
namespace {

constexpr std::uint32_t k_realtime_cycles = 600;  // every frame, including the worst-case ones

void* volatile g_block = nullptr;

// The mutant: a node that allocates in one tick if enabled.
struct Extra {
  std::uint32_t number = 0;
};
struct AllocateOnce {
  bool enabled = false;
  void operator()(const Now& now, Extra& extra) const noexcept {
    extra.number = now.number;
    if (!enabled || now.number != 1000) return;
    g_block = std::malloc(64);
    std::free(g_block);
  }
};
using OutputAndMutant =
    graph::Graph<graph::Inputs<Now, graph::Latest<Estimates>, graph::Latest<RobotFrame>,
                               graph::Latest<PenButtons>>,
                 graph::Outputs<PoseSamples, CanFrames, Extra>, PredictTools, PackCan,
                 AllocateOnce>;

template <class G>
void activate(G& graph) noexcept [[clang::nonblocking]] {
  graph.activate();
}

}  // namespace
}  // namespace glint::footprint

int main(int argc, char** argv) {
  using namespace glint::footprint;
  Groups<OutputAndMutant> groups;
  groups.tick().node<AllocateOnce>().enabled = argc == 2 && std::strcmp(argv[1], "allocate") == 0;
  for (std::uint32_t i = 0; i < k_realtime_cycles; ++i) {
    groups.cycle(i, [](auto& graph) { activate(graph); });
  }
  std::printf("%u cycles without a report, %d tools measured at the end\n", k_realtime_cycles,
              groups.measured_now());
  return groups.measured_now() == glint::k_tools_max ? 0 : 1;
}
