// The weighted fit over the markers that each tool was given: its most likely pose, and how sure
// that is. By tool, as Correspond: slice i of n takes the tools whose number leaves i.
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

// Of markers that lie where they were predicted three are enough.
inline constexpr int k_predicted_left_least = 3;

// A pose that the noise does not explain, with any one marker left out or with all, is given with a
// covariance grown to what its residuals show, and where four times the noise would not do either
// it is none: its reason is bad_fit. So it is where three markers, or what was forgiven, put the
// tool where its followed motion cannot have brought it. The mask names the markers that count.
// For three isolated markers or fewer the filter receives a measurement linearised at its
// prediction; for a flat tool nearly face-on, one linearised face-on. The rival labeling is fitted,
// too: choose_reading.hpp selects a reading and returns its odds against the others.
struct RefinePose {
  static constexpr std::array<std::string_view, 5> k_loops = {"call", "tools", "fits", "steps",
                                                              "marker_steps"};
  [[nodiscard]] static constexpr graph::LoopCounts worst(const Limits& limits) noexcept {
    return worst(limits, {0, k_tool_slices});
  }
  [[nodiscard]] static constexpr graph::LoopCounts worst(const Limits& limits,
                                                         graph::Slice slice) noexcept {
    const std::int64_t tools = tools_of(limits, slice);
    const RefineWork work = work_max(limits.markers_per_tool);
    return {{1, tools, tools * work.fits, tools * work.steps, tools * work.marker_steps}};
  }
  [[nodiscard]] graph::LoopCounts counts() const noexcept { return counts_; }

  RefineSettings settings;  // at most the default's steps are taken: worst() counts on these
  MarkerNoise noise;        // declared: until residuals show it
  bool estimate_noise = true;
  BiasCorrection correction;  // of every tool, where it holds; none unless a cell names one
  CameraUncertainty uncertainty;
  Limits limits;
  void operator()(const FrameVerdict& verdict, const Markers& markers,
                  const graph::Latest<ToolSet>& tools, const Predictions& predictions,
                  const Assignment& assignment, graph::Slice slice,
                  FittedTools& fitted) noexcept GLINT_NONBLOCKING;

 private:
  // What the residuals of a pose cost, in steps of a fit, what two poses face-on do, and what the
  // systematic covariance does.
  static constexpr int k_residual_steps = 5;
  static constexpr int k_systematic_steps = 5;
  // What the markers tell a filter may be read a second time, near where the tool is expected; of
  // the pose that stands the residuals are taken.
  [[nodiscard]] static constexpr RefineWork work_max(int markers) noexcept {
    constexpr RefineSettings k_most = {.markers_left_least = k_predicted_left_least};
    RefineWork work = refine_work_max(markers, k_most);
    work += {1, k_most.steps_max, k_most.steps_max * markers};
    work += refine_work_max(markers, {.left_out_max = 0});  // the rival labeling's
    constexpr int k_more = k_residual_steps + k_systematic_steps;
    work += {0, k_more, k_more * markers};
    return work;
  }
  void fit(const Tool& tool, const Markers& markers, const Labeling& labeling,
           const Labeling& rival, const Prediction& prediction, const MarkerNoise& now,
           double doubt, FittedTool& out) noexcept GLINT_NONBLOCKING;

  graph::LoopCounts counts_;
};

static_assert(graph::Budgeted<RefinePose, Limits>);

}  // namespace glint
