// Bounds a graph with a foreign node on a board: each node's execution time, and the response time
// of the whole against the camera's gap.
//   graph_budget [BOARD]      default: x86-64-emulated
#include <cstdio>
#include <exception>
#include <glint/platform/budget/expected_board.hpp>
#include <glint/platform/runtime/session/pipeline.hpp>
#include <glint/schedules/graph_group.hpp>
#include <glint/schedules/group_response.hpp>
#include <glint/schedules/synthesis.hpp>

#include "own_node.hpp"

namespace {

using namespace glint;

// Per iteration of each loop, in picoseconds. Invented: the author of a node measures them.
constexpr KernelCost k_own_cost{"FindNearest", {"call", "markers"}, {60'000, 9'000}};

int bound(const char* board_name) {
  const Cell cell = default_cell();
  const Board board = load_board(board_name, expected_board(), BoardUse::analyse);
  std::vector<KernelCost> kernels = board.costs;
  kernels.push_back(k_own_cost);
  const CostTable costs{board.name, board.build, board.sha256, kernels};
  if (const auto missing = missing_cost<own::Tracker>(costs); !missing.empty()) {
    std::printf("%s: no costs of %s\n", board_name, std::string(missing).c_str());
    return 1;
  }

  TaskGroup group;
  group.name = "frame";
  group.min_gap_ns = group.deadline_ns = cell.camera.period.nanoseconds;
  group.nodes = task_nodes_of<own::Tracker>();
  set_bounds<own::Tracker>(group, costs, limits_of(cell));
  for (const TaskNode& node : group.nodes) {
    std::printf("%-16s %9.3f us\n", node_name(node).c_str(),
                static_cast<double>(node.bound_ns) / 1e3);
  }
  TaskModel model;
  model.cores = cell.workers;
  model.groups = {group};
  model.system = board.system;
  const GroupResponse response = group_responses(model, synthesize(model)).front();
  std::printf("response %.3f ms of %.3f ms\n",
              static_cast<double>(response.response_ns.value_or(-1)) / 1e6,
              static_cast<double>(response.deadline_ns) / 1e6);
  return response.meets_deadline() ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return bound(argc > 1 ? argv[1] : "x86-64-emulated");
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
  }
}
