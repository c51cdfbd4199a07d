// Plots of a report as SVG text: lines over time, error histograms with a Gaussian fit,
// trajectories in top and side view, latencies.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "kernels/geometry.hpp"
#include "platform/tools/report/axes.hpp"
#include "platform/tools/report/statistics.hpp"

namespace glint {

struct LineSeries {
  std::string name;
  std::vector<Vector2> points;  // in the axes' units; a non-finite point breaks the line
};

struct HistogramSeries {
  std::string name;
  Histogram histogram;
  GaussianFit fit;  // drawn if valid
};

struct TrajectorySeries {
  std::string name;
  std::vector<Vector3> points_m;
};

[[nodiscard]] std::string line_plot(const AxesText& text, std::span<const LineSeries> series);

// Bars are relative frequencies, so that series of different length compare; the fits are dashed.
[[nodiscard]] std::string histogram_plot(const AxesText& text,
                                         std::span<const HistogramSeries> series);

// Two panels of equal scale: top view (x right, y up) and side view (x right, z up).
[[nodiscard]] std::string trajectory_plot(const std::string& title,
                                          std::span<const TrajectorySeries> series);

// Bars up to p99.9, with p50, p99 and p99.9 marked; the maximum is in the title.
[[nodiscard]] std::string latency_plot(const std::string& title,
                                       std::span<const double> latencies_us);

}  // namespace glint
