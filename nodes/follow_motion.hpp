// Follows each tool's motion from frame to frame: the filter and the rest window of
// kernels/motion/motion_track.hpp, in the frame that the pose is kept in (the world where the
// headset knew its own pose, else the camera's).
//
// The filters travel as a token, so that a frame which is abandoned leaves no trace; the rest
// windows' sums stay here, for a frame only ever writes entries that the one before does not need.
// Cost:   an update of filter and rest window for each tool found, by up to k_rest_levels tests.
// Worst:  all tools found, all at rest for as long as the window reaches.
#pragma once

#include <array>
#include <string_view>

#include "graph/graph.hpp"
#include "kernels/motion/motion_track.hpp"
#include "kernels/nonblocking.hpp"
#include "kernels/pose/tool.hpp"
#include "nodes/node_limits.hpp"
#include "nodes/tokens.hpp"

namespace glint {

struct FollowMotion {
  static constexpr std::array<std::string_view, 4> k_loops = {"call", "tools", "poses",
                                                              "rest_tests"};
  [[nodiscard]] static constexpr graph::LoopCounts worst(const Limits& limits) noexcept {
    return worst(limits, {0, k_tool_slices});
  }
  [[nodiscard]] static constexpr graph::LoopCounts worst(const Limits& limits,
                                                         graph::Slice slice) noexcept {
    const std::int64_t tools = tools_of(limits, slice);
    return {{1, tools, tools, tools * k_rest_levels}};
  }
  [[nodiscard]] graph::LoopCounts counts() const noexcept { return counts_; }

  ToolMotionSettings settings;
  Limits limits;
  void operator()(const FrameVerdict& verdict, const Anchor& anchor,
                  const graph::Latest<ToolSet>& tools,
                  const graph::Parts<FittedTools, k_tool_slices>& fitted,
                  const graph::Previous<graph::Parts<FollowedTools, k_tool_slices>>& last,
                  graph::Slice slice, FollowedTools& followed) noexcept GLINT_NONBLOCKING;

 private:
  std::array<RestSums, k_tools_per_slice> sums_;
  graph::LoopCounts counts_;
};

static_assert(graph::Budgeted<FollowMotion, Limits>);

}  // namespace glint
