// Regions of interest (ROIs) in the image, in which the tools are searched.
//
// A tool detected in the last frame is searched around its prediction. If any tool was not (never
// found, missed, out of view), the whole frame is searched; the budget covers this. If the whole
// frame had more runs than the budget, one part of it and the boxes are searched, a different part
// each frame.
// Cost: (tools - 1)^2 comparisons of boxes.
// Worst input: the last tool's box overlaps the others one after the other, each only after the
// merge with the one before.
// Source: Puljiz et al., section III: region of interest about the prediction.
#pragma once

#include <array>
#include <string_view>

#include "graph/graph.hpp"
#include "kernels/image/roi.hpp"
#include "kernels/nonblocking.hpp"
#include "kernels/pose/camera_model.hpp"
#include "kernels/pose/tool.hpp"
#include "nodes/node_limits.hpp"
#include "nodes/tokens.hpp"

namespace glint {

// ROIs around the predictions, or the whole frame; none for a rejected frame.
struct LocateRois {
  static constexpr std::array<std::string_view, 3> k_loops = {"call", "tools", "comparisons"};
  // Of n boxes the first n - 1 can be disjoint: (n - 1)(n - 2) / 2 comparisons. The last box can
  // then merge with each as the last of those left: n (n - 1) / 2 more.
  [[nodiscard]] static constexpr graph::LoopCounts worst(const Limits& limits) noexcept {
    const std::int64_t others = limits.tools - 1;
    return {{1, limits.tools, others * others}};
  }
  [[nodiscard]] graph::LoopCounts counts() const noexcept { return counts_; }

  CameraModel camera;
  Limits limits;
  void operator()(const FrameVerdict& verdict, const graph::Latest<ToolSet>& tools,
                  const Predictions& predictions, Rois& rois) noexcept GLINT_NONBLOCKING;

 private:
  void search_part(const ToolSet& set, int count, const Predictions& predictions,
                   Rois& rois) noexcept GLINT_NONBLOCKING;

  graph::LoopCounts counts_;
};

static_assert(graph::Budgeted<LocateRois, Limits>);

}  // namespace glint
