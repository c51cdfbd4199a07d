// Cost of a frame as a function of the numbers of tools and stray reflections, with its bound.
#pragma once

#include <string>
#include <vector>

#include "platform/budget/board_file.hpp"
#include "platform/budget/curve/crowd_point.hpp"
#include "platform/budget/measure/observations.hpp"

namespace glint {

// In the board's unit: instructions or nanoseconds.
struct CurveRow {
  DenseScenePoint point;
  std::size_t frames = 0;
  double median = 0, maximum = 0;
  double bound = 0;  // of the frame group for this point's cell: all nodes at their maxima
  [[nodiscard]] bool holds() const { return maximum <= bound; }
};

[[nodiscard]] std::vector<CurveRow> cost_curve(const Observations& seen, const Board& board);

// Line plots as SVG text: cost against stray reflections, and against tools.
[[nodiscard]] std::string strays_plot(const std::vector<CurveRow>& rows, const std::string& unit);
[[nodiscard]] std::string tools_plot(const std::vector<CurveRow>& rows, const std::string& unit);

}  // namespace glint
