#include "platform/budget/curve/crowd_point.hpp"

#include "platform/sim/crowded.hpp"

namespace glint {
namespace {

constexpr std::uint64_t k_tools_random_seed = 1;
constexpr int k_usual_tools = 5;
constexpr int k_usual_strays = 20;

}  // namespace

std::vector<DenseScenePoint> crowd_points() {
  std::vector<DenseScenePoint> points;
  for (const int strays : {0, 5, 10, 20, 40, 60, 80, 100, 150, 200}) {
    points.push_back({k_usual_tools, strays});
  }
  for (const int tools : {1, 2, 3, 4, 6, 8, 10, 12, 14, 16}) {
    points.push_back({tools, k_usual_strays});
  }
  points.push_back({1, sim::k_strays_max});
  points.push_back({k_tools_max, sim::k_strays_max});
  return points;
}

Cell crowd_cell(int tools) {
  Cell cell = default_cell();
  cell.tools = sim::crowd_of_tools(tools, k_tools_random_seed);
  cell.budget.tools = tools;
  if (tools > k_usual_tools) {
    cell.budget.blobs = k_blobs_max;
    cell.budget.runs_per_band = k_runs_per_band_max;
    cell.budget.search_steps = k_search_steps_max;
  }
  return cell;
}

}  // namespace glint
