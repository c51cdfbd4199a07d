// The nodes from candidate markers to poses. By tool: slice i of n takes the tools whose number
// leaves i when divided by n, so that the split is a constant of the graph.
#pragma once

#include "graph/graph.hpp"
#include "kernels/pose/assign.hpp"
#include "kernels/pose/correspond.hpp"
#include "kernels/pose/fit_covariance.hpp"
#include "kernels/pose/marker.hpp"
#include "kernels/pose/rigid_fit.hpp"
#include "kernels/pose/tool.hpp"
#include "nodes/tokens.hpp"

namespace glint {

inline constexpr int k_tool_slices = 2;

// The labelings that each tool of this slice could have.
struct Correspond {
  CorrespondSettings settings;
  void operator()(const FrameVerdict& verdict, const Markers& markers,
                  const graph::Latest<ToolSet>& tools, const Predictions& predictions,
                  graph::Slice slice, ToolLabelings& labelings) noexcept;
};

// Gives each marker to at most one tool, in one fixed order.
struct AssignMarkers {
  void operator()(const FrameVerdict& verdict, const graph::Latest<ToolSet>& tools,
                  const graph::Parts<ToolLabelings, k_tool_slices>& labelings,
                  Assignment& assignment) noexcept;

 private:
  std::array<Labelings, k_tools_max> per_tool_;  // the slices' answers, by tool
  std::array<int, k_tools_max> chosen_{};
};

// The declared noise of one marker: 1 sigma along its ray and, from the pixel's, across it.
struct MarkerNoise {
  double range_sigma_m = 0.0015;
  double pixel_sigma_px = 0.1;  // an axis
  double focal_px = 0;          // 0: as much across as along (points without an image)
};

// The rigid fit over the markers assigned, with the first-order covariance of the tip.
struct FitRigid {
  MarkerNoise noise;
  void operator()(const FrameVerdict& verdict, const Markers& markers,
                  const graph::Latest<ToolSet>& tools, const Assignment& assignment,
                  graph::Slice slice, FittedTools& fitted) const noexcept;
};

}  // namespace glint
