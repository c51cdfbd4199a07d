// Where in the image to look for the tools.
//
// A tool seen in the last frame is searched for around its prediction; as soon as one is not (never
// found, missed, gone), the whole frame is searched, which the budget covers anyway. Where the
// whole frame had more runs than that, a part of it is, another each frame, and the boxes.
// Cost: (tools - 1)^2 comparisons of boxes.
// Worst input: the last tool's box meets the others one after the other, each only once the one
// before has been merged.
// Source: the seed, section III: a region of interest about the prediction.
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

// The rectangles to search: around the priors, or the whole frame; none for a refused frame.
struct LocateRois {
  static constexpr std::array<std::string_view, 3> k_loops = {"call", "tools", "comparisons"};
  // Of n boxes the first n - 1 can stay apart, (n - 1)(n - 2) / 2 comparisons, and the last can
  // then be merged with each at the last of those that are left, n (n - 1) / 2 more.
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
