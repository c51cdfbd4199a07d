// Weighted pose fit of each tool's labelled markers: maximum-likelihood pose and its covariance.
// Split by tool as Correspond: partition i of n takes the tools with index modulo n = i.
#pragma once

#include <array>
#include <string_view>

#include "graph/graph.hpp"
#include "kernels/nonblocking.hpp"
#include "kernels/pose/bias_correction.hpp"
#include "kernels/pose/marker.hpp"
#include "kernels/pose/marker_sight.hpp"
#include "kernels/pose/refine_pose.hpp"
#include "kernels/pose/systematic_covariance.hpp"
#include "kernels/pose/tool.hpp"
#include "nodes/node_limits.hpp"
#include "nodes/tokens.hpp"

namespace glint {

// Markers at their predicted positions: three are enough.
inline constexpr int k_predicted_markers_min = 3;

// If the fit fails the chi-square test with all markers and with any single marker removed, its
// covariance is scaled by the reduced chi-square (Birge 1932), at most by 16; unless it follows a
// tracked motion, its odds are divided by what that exceeds the doubt about the noise by. Above 16
// the result is `bad_fit`. `bad_fit` is also the result if a pose of three markers, or one with
// inflated covariance or a removed marker, contradicts the tracked motion. The mask holds the
// markers used. For three isolated markers or fewer the filter receives a measurement linearised at
// its prediction; for a flat tool nearly face-on, one linearised face-on. The alternative labeling
// is fitted, too: choose_hypothesis.hpp selects a pose hypothesis and returns its odds against the
// others.
struct RefinePose {
  static constexpr std::array<std::string_view, 5> k_loops = {"call", "tools", "fits", "steps",
                                                              "marker_steps"};
  [[nodiscard]] static constexpr graph::LoopCounts worst(const Limits& limits) noexcept {
    return worst(limits, {0, k_tool_partitions});
  }
  [[nodiscard]] static constexpr graph::LoopCounts worst(const Limits& limits,
                                                         graph::Partition partition) noexcept {
    const std::int64_t tools = tools_of(limits, partition);
    const RefineWork work = work_max(limits.markers_per_tool);
    return {{1, tools, tools * work.fits, tools * work.steps, tools * work.marker_steps}};
  }
  [[nodiscard]] graph::LoopCounts counts() const noexcept { return counts_; }

  RefineSettings settings;  // at most the default's steps are taken: worst() assumes these
  MarkerNoise noise;        // declared noise, until residuals estimate it
  bool estimate_noise = true;
  BiasCorrection correction;  // of every tool, within its range; none unless a cell names one
  CameraUncertainty uncertainty;
  Limits limits;
  void operator()(const FrameVerdict& verdict, const Markers& markers,
                  const graph::Latest<ToolSet>& tools, const Predictions& predictions,
                  const Assignment& assignment, graph::Partition partition,
                  FittedTools& fitted) noexcept GLINT_NONBLOCKING;

 private:
  // Cost in steps of a fit: of the residuals of a pose, of two face-on linearisations and of the
  // systematic covariance.
  static constexpr int k_residual_steps = 5;
  static constexpr int k_systematic_steps = 5;
  // The markers may be fitted once more near the prediction, for the filter. Residuals are computed
  // for the chosen pose.
  [[nodiscard]] static constexpr RefineWork work_max(int markers) noexcept {
    constexpr RefineSettings k_defaults = {.markers_kept_min = k_predicted_markers_min};
    RefineWork work = refine_work_max(markers, k_defaults);
    work += {1, k_defaults.steps_max, k_defaults.steps_max * markers};
    work += refine_work_max(markers, {.rejected_max = 0});  // the alternative labeling's fit
    constexpr int k_more = k_residual_steps + k_systematic_steps;
    work += {0, k_more, k_more * markers};
    return work;
  }
  void fit(const Tool& tool, const Markers& markers, const Labeling& labeling,
           const Labeling& alternative, const Prediction& prediction, const MarkerNoise& now,
           double variance_factor, FittedTool& out) noexcept GLINT_NONBLOCKING;

  graph::LoopCounts counts_;
};

static_assert(graph::Budgeted<RefinePose, Limits>);

}  // namespace glint
