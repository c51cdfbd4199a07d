#include <algorithm>
#include <cmath>

#include "platform/budget/report/drawing.hpp"
#include "platform/budget/report/figures.hpp"
#include "platform/tools/report/statistics.hpp"
#include "platform/tools/report/svg.hpp"

namespace glint {
namespace {

std::string micro(double us) { return number_text(us, us < 100 ? 2 : 1) + " \u00b5s"; }

}  // namespace

Illustration stages_figure(const std::string& name, const std::string& caption,
                           const std::vector<StageBar>& stages, double deadline_us) {
  constexpr double width = 1080, left = 190, right = 130, row = 22;
  double total = 0;
  for (const StageBar& stage : stages) total += stage.us;
  const double range = std::max({total, deadline_us, 1e-3}) * 1.02;
  const double height = row * static_cast<double>(stages.size());
  const double scale = (width - left - right) / range;
  Drawing drawing(width, height + 46, caption);
  drawing.x_axis({left, 6, width - left - right, height + 4}, range,
                 "\u00b5s from the chain's start");
  double y = 10, at = 0;
  for (const StageBar& stage : stages) {
    drawing.text(left - 8, y + 12, fitting(stage.name, left - 12), "end");
    drawing.box({left + at * scale, y, std::max(0.8, stage.us * scale), row - 7},
                "fill-" + stage.kind, stage.name + ": " + micro(stage.us) + ", " + stage.kind);
    const double after = left + (at + stage.us) * scale + 6;
    drawing.text(std::min(after, width - 128), y + 12, micro(stage.us) + ", " + stage.kind,
                 stage.kind == "declared" ? "faint small" : stage.kind + " small");
    at += stage.us;
    y += row;
  }
  if (deadline_us > 0) {
    const double x = left + deadline_us * scale;
    drawing.line(x, 0, x, height + 10, "deadline");
    drawing.text(x + 5, 11, "deadline", "bad small");
  }
  return {name, caption, drawing.finished()};
}

Illustration slack_figure(const std::string& name, const std::string& caption,
                          const std::vector<SlackBar>& bars) {
  constexpr double width = 1080, left = 250, right = 90, row = 20;
  double least = 0;
  for (const SlackBar& bar : bars) least = std::min(least, bar.percent);
  least = std::max(least, -100.0);  // larger overshoots are shown as a number only
  const double scale = (width - left - right) / (100 - least);
  const double zero = left - least * scale;
  const double height = row * static_cast<double>(bars.size());
  Drawing drawing(width, height + 44, caption);
  for (double percent = std::ceil(least / 20) * 20; percent <= 100; percent += 20) {
    const double x = zero + percent * scale;
    drawing.line(x, 4, x, height + 8, percent == 0 ? "axis" : "grid");
    drawing.text(x, height + 22, number_text(percent, 0) + " %", "faint small middle");
  }
  drawing.text(width - right, height + 38, "slack to the deadline", "faint small end");
  double y = 8;
  for (const SlackBar& bar : bars) {
    const bool short_of = bar.percent < 0;
    const double end = zero + std::max(bar.percent, least) * scale;
    drawing.text(left - 8, y + 11, fitting(bar.name, left - 12), "end");
    drawing.box({std::min(zero, end), y, std::abs(end - zero), row - 7},
                short_of ? "fill-bad" : "fill-bound");
    drawing.text(std::max(end, zero) + 6, y + 11,
                 number_text(bar.percent, 1) + " %" + (bar.percent < 0 ? " over" : ""),
                 short_of ? "bad small" : "small");
    y += row;
  }
  return {name, caption, drawing.finished()};
}

Illustration histogram_figure(const NodeTimes& node) {
  constexpr double width = 340, height = 150, left = 10, right = 12, top = 40, bottom = 32;
  constexpr int bins = 64;
  const double most = *std::max_element(node.us.begin(), node.us.end());
  // Values far beyond the bound are only counted, so that one outlier does not hide the shape.
  const double range =
      1.08 * (node.bound_us > 0 ? std::max(node.bound_us, std::min(most, 1.5 * node.bound_us))
                                : std::max(most, 1e-3));
  const Histogram histogram = make_histogram(node.us, 0, range, bins);
  std::size_t greatest = histogram.above;
  for (const std::size_t count : histogram.counts) greatest = std::max(greatest, count);
  const double full = std::log10(1.0 + static_cast<double>(greatest));
  const double scale = (width - left - right) / range;
  const double floor = height - bottom;
  std::string caption = node.node + ": " + std::to_string(node.us.size()) + " observed, p50 " +
                        micro(percentile(node.us, 0.5)) + ", p99.9 " +
                        micro(percentile(node.us, 0.999)) + ", max " + micro(most);
  if (node.bound_us > 0) {
    caption += "; bound " + micro(node.bound_us) + ", " + std::to_string(node.above) + " above it";
  }
  Drawing drawing(width, height, caption);
  drawing.text(0, 13, node.node, "strong");
  drawing.text(width - right, 13, "n " + std::to_string(node.us.size()), "faint small end");
  drawing.text(0, 29, "p50 " + micro(percentile(node.us, 0.5)) + "  max " + micro(most),
               "observed small");
  drawing.x_axis({left, top, width - left - right, floor - top}, range, "\u00b5s", 6);
  const auto bar = [&](double x, double bar_width, std::size_t count, std::string_view fill) {
    if (count == 0) return;
    const double size = (floor - top) * std::log10(1.0 + static_cast<double>(count)) / full;
    drawing.box({x, floor - size, bar_width, size}, fill, std::to_string(count) + " calls");
  };
  for (std::size_t bin = 0; bin < histogram.counts.size(); ++bin) {
    const double from = static_cast<double>(bin) * histogram.width;
    const bool beyond = node.bound_us > 0 && from >= node.bound_us;
    bar(left + from * scale, histogram.width * scale - 0.4, histogram.counts[bin],
        beyond ? "fill-bad" : "fill-observed");
  }
  bar(width - right + 2, 6, histogram.above, "fill-bad");
  if (node.bound_us > 0) {
    const double x = left + node.bound_us * scale;
    drawing.line(x, top - 5, x, floor, "boundline");
    drawing.text(x + 3, top - 8, "bound " + micro(node.bound_us), "bound small end");
    if (node.above > 0) {
      drawing.text(width - right, top + 8, std::to_string(node.above) + " above", "bad small end");
    }
  }
  std::string file = node.group + "-" + node.node;
  std::replace(file.begin(), file.end(), '#', '-');
  return {"histogram-" + file, caption, drawing.finished()};
}

Illustration quantile_figure(const std::string& name, const std::string& title,
                             const ExtremeEstimate& estimate) {
  constexpr double width = 340, height = 280, left = 62, top = 30, size = 200;
  const std::vector<double>& verification = estimate.verification_values;
  const auto n = static_cast<double>(verification.size());
  std::vector<double> expected;
  for (std::size_t i = 0; i < verification.size(); ++i) {
    expected.push_back(estimate.distribution.quantile((static_cast<double>(i) + 0.5) / n));
  }
  const double low = std::min(verification.front(), expected.front());
  const double high = std::max({verification.back(), expected.back(), low + 1e-9});
  const auto place = [&](double value) { return (value - low) / (high - low) * size; };
  const std::string caption =
      title + ": the validation half (" + std::to_string(verification.size()) +
      " extremes) over the fit's quantiles. Points on the line: both agree.";
  Drawing drawing(width, height, caption);
  drawing.text(0, 14, title, "strong");
  drawing.box({left, top, size, size}, "lane");
  drawing.line(left, top + size, left + size, top, "axis");
  for (std::size_t i = 0; i < verification.size(); ++i) {
    drawing.box({left + place(expected[i]) - 2, top + size - place(verification[i]) - 2, 4, 4},
                "fill-observed dot");
  }
  drawing.text(left, top + size + 14, micro(low), "faint small");
  drawing.text(left + size, top + size + 14, micro(high), "faint small end");
  drawing.text(left + size / 2, top + size + 30, "fitted", "estimate small middle");
  drawing.text(left - 6, top + size / 2, "observed", "observed small end");
  return {name, caption, drawing.finished()};
}

}  // namespace glint
