// Is the new kernel's loop in its node's budget: a maximum that the worst input reaches, and costs
// that a board file of the older node lacks?
#include <cstdio>
#include <memory>
#include <string>

#include "nodes/tracker.hpp"
#include "platform/budget/expected_board.hpp"
#include "platform/budget/inputs/image_inputs.hpp"
#include "schedules/node_bounds.hpp"

int main() {
  using namespace glint;
  const auto markers = std::make_unique<Markers>();
  markers->count = 3;
  markers->items[1].ray = Vector3::UnitX();
  const auto pairs = static_cast<int>(merge_equal_markers(1e-4, *markers));
  std::printf("%d pairs, %d kept\n", pairs, markers->count);

  const auto kernel = measured_back_project();
  const Limits limits;
  kernel->set_input(InputKind::worst, 0, limits);
  kernel->run();
  std::printf("%zu loops, %s\n", kernel->loops().size(),
              kernel->counts() == kernel->worst(limits) ? "at their maxima" : "below");
  const Board board = load_board("x86-64-emulated", expected_board(), BoardUse::analyse);
  const CostTable costs = board.table();
  std::printf("no costs of %s\n", std::string(missing_cost<Tracker>(costs)).c_str());
}
