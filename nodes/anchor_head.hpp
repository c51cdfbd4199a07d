// Corrects the head's pose by the reference body, where one is declared and in view, so that every
// tool of the frame is given relative to it; without one it says how sure the headset itself is.
// Cost:   one update of kernels/motion/head_anchor.hpp, dearer with the body in view.
// Worst:  the body in view after a gap.
#pragma once

#include <array>
#include <string_view>

#include "graph/graph.hpp"
#include "kernels/motion/head_anchor.hpp"
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
  int reference = -1;  // number of the tool that does not move; -1: there is none
  void operator()(const FrameVerdict& verdict, const HeadPose& head,
                  const graph::Latest<ToolSet>& tools,
                  const graph::Parts<FittedTools, k_tool_slices>& fitted,
                  const graph::Previous<Anchor>& last, Anchor& anchor) noexcept GLINT_NONBLOCKING;

 private:
  graph::LoopCounts counts_;
};

static_assert(graph::Budgeted<AnchorHead, Limits>);

}  // namespace glint
