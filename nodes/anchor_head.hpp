// Corrects the drift of the head pose by a static reference body, where one is declared and
// visible. All tools of the frame are then relative to that body. Without it, returns the headset's
// own localisation covariance.
// Cost:   one update of kernels/motion/head_drift_correction.hpp; with the body visible, more.
// Worst:  the body is visible again after a gap.
#pragma once

#include <array>
#include <string_view>

#include "graph/graph.hpp"
#include "kernels/motion/head_drift_correction.hpp"
#include "kernels/nonblocking.hpp"
#include "kernels/pose/head_pose.hpp"
#include "kernels/pose/tool.hpp"
#include "nodes/node_limits.hpp"
#include "nodes/tokens.hpp"

namespace glint {

struct AnchorHead {
  static constexpr std::array<std::string_view, 2> k_loops = {"call", "sights"};
  [[nodiscard]] static constexpr graph::LoopCounts worst(const Limits&) noexcept {
    return {{1, 1}};
  }
  [[nodiscard]] graph::LoopCounts counts() const noexcept { return counts_; }

  HeadNoise noise;
  Limits limits;
  int reference = -1;  // index of the static reference tool; -1: none
  void operator()(const FrameVerdict& verdict, const HeadPose& head,
                  const graph::Latest<ToolSet>& tools,
                  const graph::Parts<FittedTools, k_tool_partitions>& fitted,
                  const graph::Previous<Anchor>& last, Anchor& anchor) noexcept GLINT_NONBLOCKING;

 private:
  graph::LoopCounts counts_;
};

static_assert(graph::Budgeted<AnchorHead, Limits>);

}  // namespace glint
