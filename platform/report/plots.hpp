// The diagrams of a report, as SVG text: lines over time, error histograms with the bell that fits
// them, trajectories from above and from the side, latencies.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "kernels/geometry.hpp"
#include "platform/report/axes.hpp"
#include "platform/report/statistics.hpp"

namespace glint {

struct LineSeries {
  std::string name;
  std::vector<Vector2> points;  // in the axes' units; a point that is not finite breaks the line
};

struct HistogramSeries {
  std::string name;
  Histogram histogram;
  GaussianFit fit;  // drawn where valid
};

struct TrajectorySeries {
  std::string name;
  std::vector<Vector3> points_m;
};

[[nodiscard]] std::string line_plot(const AxesText& text, std::span<const LineSeries> series);

// Bars as parts of all values, so that series of unequal length compare; the fits as dashed lines.
[[nodiscard]] std::string histogram_plot(const AxesText& text,
                                         std::span<const HistogramSeries> series);

// Two panels of one scale: from above (x to the right, y up) and from the side (x to the right, z
// up).
[[nodiscard]] std::string trajectory_plot(const std::string& title,
                                          std::span<const TrajectorySeries> series);

// Bars up to p99.9, with p50, p99 and p99.9 marked; the greatest value stands in the title.
[[nodiscard]] std::string latency_plot(const std::string& title,
                                       std::span<const double> latencies_us);

}  // namespace glint
