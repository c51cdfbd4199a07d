// A graph of two nodes. Order and buffers follow from what each call operator reads and writes.
#include <cstdio>
#include <glint/graph/graph.hpp>

namespace {

namespace graph = glint::graph;

struct Voltage {
  double value = 0;
};
struct Smoothed {
  double value = 0;
};
struct Alarm {
  bool is_on = false;
};

// First-order low-pass filter: reads its own last output.
struct Smooth {
  double weight = 0.5;
  void operator()(const Voltage& voltage, const graph::Previous<Smoothed>& last,
                  Smoothed& smoothed) const noexcept {
    smoothed.value = weight * voltage.value + (1 - weight) * last.value().value;
  }
};

struct Compare {
  double limit = 8;
  void operator()(const Smoothed& smoothed, Alarm& alarm) const noexcept {
    alarm.is_on = smoothed.value > limit;
  }
};

// The nodes may be listed in any order.
using Watch =
    graph::Graph<graph::Inputs<Voltage>, graph::Outputs<Smoothed, Alarm>, Compare, Smooth>;
static_assert(graph::valid<Watch>);

}  // namespace

int main() {
  static Watch watch;
  watch.node<Compare>().limit = 8.5;
  for (const double volts : {10.0, 10.0, 10.0, 10.0}) {
    watch.input<Voltage>().value = volts;
    watch.activate();
    std::printf("%.3f V %s\n", watch.output<Smoothed>().value,
                watch.output<Alarm>().is_on ? "alarm" : "no alarm");
  }
}
