// Is the new node in the tracker: ordered, with its cell's limits, measured, and missed in a board
// file without its costs?
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "graph/describe.hpp"
#include "platform/budget/expected_board.hpp"
#include "platform/budget/measured_kernel.hpp"
#include "platform/runtime/session/pipeline.hpp"
#include "schedules/node_bounds.hpp"

int main() {
  using namespace glint;
  for (const graph::NodeInfo& node : graph::Description<Tracker>::nodes) {
    if (node.name == "BackProject" || node.name == "FindNearestRange") {
      std::printf("runs %s\n", std::string(node.name).c_str());
    }
  }
  const Cell cell = default_cell();
  const auto tracker = std::make_unique<Tracker>();
  configure(cell, *tracker);
  tracker->latest<ToolSet>().set(cell.tools, 1, 0);
  tracker->activate();
  std::printf("limits %d, range %.1f\n", tracker->node<FindNearestRange>().limits.blobs,
              tracker->output<NearestRange>().range_m);

  std::vector<std::unique_ptr<MeasuredKernel>> kernels;
  add_pose_kernels(kernels);
  for (const auto& kernel : kernels) {
    if (kernel->name() != "FindNearestRange") continue;
    kernel->set_input(InputKind::worst, 0, limits_of(cell));
    kernel->run();
    std::printf("measured, %s\n",
                kernel->counts() == kernel->worst(limits_of(cell)) ? "at its maxima" : "below");
  }
  const Board board = load_board("x86-64-emulated", expected_board(), BoardUse::analyse);
  const CostTable costs = board.table();
  std::printf("no costs of %s\n", std::string(missing_cost<Tracker>(costs)).c_str());
}
