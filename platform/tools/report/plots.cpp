#include "platform/tools/report/plots.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace glint {
namespace {

constexpr double k_left = 74, k_top = 42, k_right = 22, k_bottom = 54;
constexpr double k_plot_width = 640, k_plot_height = 340;
constexpr int k_gaussian_curve_points = 200;
constexpr int k_latency_bins = 60;

SvgCanvas canvas_for(double plot_width, double plot_height) {
  return {k_left + plot_width + k_right, k_top + plot_height + k_bottom};
}

struct Limits {
  Range x{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  Range y = x;
  void take(double px, double py) {
    if (!std::isfinite(px) || !std::isfinite(py)) return;
    x = {std::min(x.low, px), std::max(x.high, px)};
    y = {std::min(y.low, py), std::max(y.high, py)};
  }
};

double total(const Histogram& histogram) {
  double sum = static_cast<double>(histogram.below + histogram.above);
  for (const std::size_t count : histogram.counts) sum += static_cast<double>(count);
  return std::max(sum, 1.0);
}

// Relative frequency per unit of x, so that bins of different width compare.
double density(const HistogramSeries& series, double count) {
  return count / (total(series.histogram) * series.histogram.width);
}

std::vector<Vector2> gaussian_curve(const HistogramSeries& series, const Range& x) {
  std::vector<Vector2> points;
  for (int i = 0; i <= k_gaussian_curve_points; ++i) {
    const double at = x.low + x.span() * i / k_gaussian_curve_points;
    points.emplace_back(at, density(series, series.fit.at(at)));
  }
  return points;
}

// Equal scale on both axes: extends the smaller span about its middle.
Range extended_to(const Range& range, double span) {
  const double middle = 0.5 * (range.low + range.high);
  return {middle - 0.5 * span, middle + 0.5 * span};
}

}  // namespace

std::string line_plot(const AxesText& text, std::span<const LineSeries> series) {
  Limits limits;
  for (const LineSeries& line : series)
    for (const Vector2& point : line.points) limits.take(point.x(), point.y());
  SvgCanvas canvas = canvas_for(k_plot_width, k_plot_height);
  Axes axes(canvas, {k_left, k_top}, {k_plot_width, k_plot_height}, limits.x,
            with_margin(limits.y, 0.06));
  axes.draw(text);
  for (std::size_t i = 0; i < series.size(); ++i) {
    const Stroke stroke{series_colour(i), 1.4, {}};
    axes.line(series[i].points, stroke);
    axes.legend(static_cast<int>(i), series[i].name, stroke);
  }
  return canvas.finished();
}

std::string histogram_plot(const AxesText& text, std::span<const HistogramSeries> series) {
  Limits limits;
  for (const HistogramSeries& one : series) {
    limits.take(one.histogram.low, 0);
    limits.take(one.histogram.high(), 0);
    for (const std::size_t count : one.histogram.counts)
      limits.take(one.histogram.low, density(one, static_cast<double>(count)));
    if (one.fit.valid) limits.take(one.histogram.low, density(one, one.fit.height));
  }
  SvgCanvas canvas = canvas_for(k_plot_width, k_plot_height);
  Axes axes(canvas, {k_left, k_top}, {k_plot_width, k_plot_height}, limits.x,
            {0, with_margin(limits.y, 0.06).high});
  axes.draw(text);
  int row = 0;
  for (std::size_t i = 0; i < series.size(); ++i) {
    const HistogramSeries& one = series[i];
    for (std::size_t bin = 0; bin < one.histogram.counts.size(); ++bin) {
      const double low = one.histogram.low + static_cast<double>(bin) * one.histogram.width;
      axes.bar(low, low + one.histogram.width,
               density(one, static_cast<double>(one.histogram.counts[bin])), series_colour(i), 0.4);
    }
    axes.legend(row++, one.name, {series_colour(i), 7, {}});
  }
  for (std::size_t i = 0; i < series.size(); ++i) {
    if (!series[i].fit.valid) continue;
    const Stroke stroke{series_colour(i), 1.8, "6 3"};
    axes.line(gaussian_curve(series[i], limits.x), stroke);
    axes.legend(row++, "Gaussian fit, sd " + number_text(series[i].fit.sd, 2), stroke);
  }
  return canvas.finished();
}

std::string trajectory_plot(const std::string& title, std::span<const TrajectorySeries> series) {
  Limits above, aside;
  for (const TrajectorySeries& one : series) {
    for (const Vector3& point : one.points_m) {
      above.take(point.x(), point.y());
      aside.take(point.x(), point.z());
    }
  }
  constexpr double side = 360, gap = 84;
  SvgCanvas canvas = canvas_for(2 * side + gap, side);
  double span = 1e-3;
  for (const Limits* limits : {&above, &aside})
    span = std::max({span, with_margin(limits->x, 0).span(), with_margin(limits->y, 0).span()});
  span *= 1.08;
  const auto panel = [&](double left, const Limits& limits, int axis, const AxesText& text) {
    Axes axes(canvas, {left, k_top}, {side, side}, extended_to(with_margin(limits.x, 0), span),
              extended_to(with_margin(limits.y, 0), span));
    axes.draw(text);
    for (std::size_t i = 0; i < series.size(); ++i) {
      std::vector<Vector2> points;
      for (const Vector3& point : series[i].points_m) points.emplace_back(point.x(), point[axis]);
      const Stroke stroke{series_colour(i), i == 0 ? 2.4 : 1.2, {}};
      axes.line(std::move(points), stroke);
      axes.legend(static_cast<int>(i), series[i].name, stroke);
    }
  };
  panel(k_left, above, 1, {title + ": from above", "x [m]", "y [m]"});
  panel(k_left + side + gap, aside, 2, {"from the side", "x [m]", "z [m]"});
  return canvas.finished();
}

std::string latency_plot(const std::string& title, std::span<const double> latencies_us) {
  const double p50 = percentile(latencies_us, 0.5);
  const double p99 = percentile(latencies_us, 0.99);
  const double p99_9 = percentile(latencies_us, 0.999);
  const double maximum = summarize(latencies_us).maximum;
  const double high = p99_9 > 0 ? 1.05 * p99_9 : 1;
  const Histogram histogram = make_histogram(latencies_us, 0, high, k_latency_bins);
  const std::size_t most = *std::max_element(histogram.counts.begin(), histogram.counts.end());
  SvgCanvas canvas = canvas_for(k_plot_width, k_plot_height);
  Axes axes(canvas, {k_left, k_top}, {k_plot_width, k_plot_height}, {0, high},
            {0, 1.1 * static_cast<double>(std::max<std::size_t>(most, 1))});
  axes.draw({title + " (n = " + std::to_string(latencies_us.size()) + ", max " +
                 number_text(maximum, 0) + " us)",
             "latency [us]", "count"});
  for (std::size_t bin = 0; bin < histogram.counts.size(); ++bin) {
    const double low = static_cast<double>(bin) * histogram.width;
    axes.bar(low, low + histogram.width, static_cast<double>(histogram.counts[bin]),
             series_colour(0), 0.55);
  }
  const std::pair<const char*, double> marks[] = {{"p50 ", p50}, {"p99 ", p99}, {"p99.9 ", p99_9}};
  double drop = 14;
  for (const auto& [name, value] : marks) {
    axes.vertical(value, {series_colour(1), 1.4, "4 3"}, name + number_text(value, 0) + " us",
                  drop);
    drop += 16;
  }
  return canvas.finished();
}

}  // namespace glint
