// Labels the one or two visible markers of a tool without a labeling, where they can belong to no
// other tool (partial visibility). They keep the track alive while a hand occludes the others. Does
// nothing in a frame in which every predicted tool has a labeling.
// Cost and worst input: kernels/pose/partial_visibility.hpp.
#pragma once

#include <array>
#include <string_view>

#include "graph/graph.hpp"
#include "kernels/nonblocking.hpp"
#include "kernels/pose/partial_visibility.hpp"
#include "nodes/node_limits.hpp"
#include "nodes/tokens.hpp"

namespace glint {

struct NameFew {
  static constexpr std::array<std::string_view, 4> k_loops = {"call", "tools", "gates", "tests"};
  [[nodiscard]] static constexpr graph::LoopCounts worst(const Limits& limits) noexcept {
    const std::int64_t gates = std::int64_t{limits.tools} * limits.markers_per_tool;
    return {{1, limits.tools, gates, (gates + limits.tools) * limits.blobs}};
  }
  [[nodiscard]] graph::LoopCounts counts() const noexcept { return counts_; }

  MarkerNoise noise;
  Limits limits;
  void operator()(const FrameVerdict& verdict, const Markers& markers,
                  const graph::Latest<ToolSet>& tools, const Predictions& predictions,
                  const Assignment& assignment, SeenFew& seen) noexcept GLINT_NONBLOCKING;

 private:
  std::array<PredictedTool, k_tools_max> expected_;
  PartialScratch scratch_;
  graph::LoopCounts counts_;
};

static_assert(graph::Budgeted<NameFew, Limits>);

}  // namespace glint
