// The report's figures, as SVG that takes its colours from the page.
#pragma once

#include <string>
#include <vector>

#include "platform/budget/estimate/extreme_estimate.hpp"
#include "platform/budget/report/document.hpp"
#include "platform/budget/report/run_observations.hpp"

namespace glint {

// One bar of a schedule: a node on a core, from and to in microseconds after the release.
struct GanttBar {
  std::string name;  // copies as Name#i
  int core = 0;
  double from_us = 0, to_us = 0;
  bool late = false;   // overran, or was injected with a delay
  bool other = false;  // of another group: in between, not part of the chain
};

// A plan or one activation of a run.
struct GanttStrip {
  std::string title;
  NumberKind kind = NumberKind::none;
  std::vector<GanttBar> bars;
};

// All strips above one axis, unless one is so long that the others would vanish: each then has its
// own, and the caption says so. A deadline of 0 is not drawn.
[[nodiscard]] Illustration gantt_figure(const std::string& name, const std::string& caption,
                                        const std::vector<GanttStrip>& strips, double deadline_us);

struct StageBar {
  std::string name;
  std::string kind;  // bound, estimate or declared
  double us = 0;
};

// A chain's stages one after the other, to the deadline.
[[nodiscard]] Illustration stages_figure(const std::string& name, const std::string& caption,
                                         const std::vector<StageBar>& stages, double deadline_us);

struct SlackBar {
  std::string name;
  double percent = 0;  // negative: overshoot
};
[[nodiscard]] Illustration slack_figure(const std::string& name, const std::string& caption,
                                        const std::vector<SlackBar>& bars);

// How often a node took how long, with its bound; counts on a logarithmic scale, since the rare
// ones are the ones that matter.
[[nodiscard]] Illustration histogram_figure(const NodeTimes& node);

// The judged half's values over what the fit says they should be.
[[nodiscard]] Illustration quantile_figure(const std::string& name, const std::string& title,
                                           const ExtremeEstimate& estimate);

}  // namespace glint
