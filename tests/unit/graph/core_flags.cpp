// Instantiates every template of a companion computer's build without exceptions and RTTI.
#include "small_graph.hpp"
#include "yielding_rest.hpp"

namespace glint::test {

int total_with_core_flags() {
  static SmallGraph graph;
  static RateGroup<SmallGraph> group(graph, 1);
  static YieldingRest rest;
  static Workers<1, YieldingRest> workers(rest);
  static Ring<Total, 4> ring;
  graph.latest<Scale>().set({2}, 1, 0);
  graph.input<Row>().numbers = {1, 2, 3, 4, 5, 6, 7, 8};
  if (!graph.prepare()) return -1;
  group.release(0);
  group.activate();
  workers.begin(graph);
  workers.run(graph, 0);
  ring.push(graph.output<Total>());
  Total total;
  return ring.pop(total) ? total.value : -1;
}

}  // namespace glint::test
