#include "platform/budget/curve/cost_curve.hpp"

#include <algorithm>
#include <map>

#include "nodes/tracker.hpp"
#include "platform/tools/report/plots.hpp"
#include "platform/tools/report/statistics.hpp"
#include "schedules/node_bounds.hpp"

namespace glint {
namespace {

constexpr int k_usual_tools = 5;
constexpr int k_usual_strays = 20;

double frame_bound(const Board& board, int tools) {
  double sum = 0;
  for (const std::int64_t bound : node_bounds<Tracker>(board.table(), limits_of(crowd_cell(tools))))
    sum += static_cast<double>(bound);
  return sum / board.ns_per_instruction;
}

std::string plot(const std::vector<CurveRow>& rows, const std::string& title,
                 const std::string& x_label, const std::string& unit,
                 int (*x_of)(const DenseScenePoint&), bool (*shown)(const DenseScenePoint&)) {
  std::vector<LineSeries> series{{"bound", {}}, {"observed max", {}}, {"observed median", {}}};
  std::map<int, const CurveRow*> in_order;
  for (const CurveRow& row : rows) {
    if (shown(row.point)) in_order[x_of(row.point)] = &row;
  }
  for (const auto& [x, row] : in_order) {
    const double at = x;
    series[0].points.emplace_back(at, row->bound / 1000);
    series[1].points.emplace_back(at, row->maximum / 1000);
    series[2].points.emplace_back(at, row->median / 1000);
  }
  return line_plot({title, x_label, "thousand " + unit + " a frame"}, series);
}

}  // namespace

std::vector<CurveRow> cost_curve(const Observations& seen, const Board& board) {
  std::vector<CurveRow> rows;
  for (const DenseScenePoint& point : crowd_points()) {
    for (const KernelObservations& kernel : seen.kernels) {
      if (kernel.name != point.name()) continue;
      std::vector<double> costs;
      for (const Observation& call : kernel.calls) costs.push_back(call.call.cost);
      CurveRow row;
      row.point = point;
      row.frames = costs.size();
      row.median = percentile(costs, 0.5);
      row.maximum = percentile(costs, 1.0);
      row.bound = frame_bound(board, point.tools);
      rows.push_back(row);
    }
  }
  return rows;
}

std::string strays_plot(const std::vector<CurveRow>& rows, const std::string& unit) {
  return plot(
      rows, "Five tools among strays: a frame's cost", "stray reflections", unit,
      [](const DenseScenePoint& point) { return point.strays; },
      [](const DenseScenePoint& point) { return point.tools == k_usual_tools; });
}

std::string tools_plot(const std::vector<CurveRow>& rows, const std::string& unit) {
  return plot(
      rows, "Tools among twenty strays: a frame's cost", "tools", unit,
      [](const DenseScenePoint& point) { return point.tools; },
      [](const DenseScenePoint& point) { return point.strays == k_usual_strays; });
}

}  // namespace glint
