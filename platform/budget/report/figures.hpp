// Figures of the report, as SVG with the page's colours.
#pragma once

#include <string>
#include <vector>

#include "platform/budget/estimate/extreme_estimate.hpp"
#include "platform/budget/report/document.hpp"
#include "platform/budget/report/run_observations.hpp"

namespace glint {

// One bar of a schedule: a node on a core; times in microseconds after the release.
struct GanttBar {
  std::string name;  // copies as Name#i
  int core = 0;
  double from_us = 0, to_us = 0;
  bool late = false;   // overran, or had an injected delay
  bool other = false;  // node of another group that ran in between
};

// A schedule or one activation of a run.
struct GanttStrip {
  std::string title;
  NumberKind kind = NumberKind::none;
  std::vector<GanttBar> bars;
};

// Draws all strips on one axis. If one strip is so long that the others would vanish, each has its
// own axis, and the caption states it. A deadline of 0 is not drawn.
[[nodiscard]] Illustration gantt_figure(const std::string& name, const std::string& caption,
                                        const std::vector<GanttStrip>& strips, double deadline_us);

struct StageBar {
  std::string name;
  std::string kind;  // bound, estimate or declared
  double us = 0;
};

// Stages of a chain one after the other, up to the deadline.
[[nodiscard]] Illustration stages_figure(const std::string& name, const std::string& caption,
                                         const std::vector<StageBar>& stages, double deadline_us);

struct SlackBar {
  std::string name;
  double percent = 0;  // negative: overshoot
};
[[nodiscard]] Illustration slack_figure(const std::string& name, const std::string& caption,
                                        const std::vector<SlackBar>& bars);

// Histogram of a node's times with its bound; counts on a logarithmic scale, so that rare long
// calls are visible.
[[nodiscard]] Illustration histogram_figure(const NodeTimes& node);

// Quantile-quantile plot of the judged half's values against the fit.
[[nodiscard]] Illustration quantile_figure(const std::string& name, const std::string& title,
                                           const ExtremeEstimate& estimate);

}  // namespace glint
