// Follows each tool's motion from frame to frame: the filter and the rest window of
// kernels/motion/motion_track.hpp, in the frame that the pose is kept in (the world where the
// headset knew its own pose, else the camera's).
//
// A frame that gives no pose but one or two markers (NameFew) moves the filter on by these, from
// what it knew. Whether that stands as a measurement is a matter of how sure the tool is then,
// whichever markers said so, and so it is of three and more: a pose whose every axis is within
// SureLimits is one, and is called measured; beyond, what is known goes on, predicted and in the
// end lost, however long the markers are in view.
//
// The filters travel as a token, so that a frame which is abandoned leaves no trace; the rest
// windows' sums stay here, for a frame only ever writes entries that the one before does not need.
// A tool whose slot holds another one than before begins anew.
// Cost:   an update of filter and rest window for each tool found, by up to k_rest_levels tests;
//         one by two markers costs less than one by a pose with its tests.
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

// What experiments call gross, 20 mm or 15 degrees beside the truth, lies four sigma off.
struct SureLimits {
  double position_m = 0.005;
  double rotation_rad = 0.065;
};

struct FollowMotion {
  static constexpr std::array<std::string_view, 4> k_loops = {"call", "tools", "moved",
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
  SureLimits sure;
  Limits limits;
  void operator()(const FrameVerdict& verdict, const Anchor& anchor,
                  const graph::Latest<ToolSet>& tools,
                  const graph::Parts<FittedTools, k_tool_slices>& fitted, const SeenFew& few,
                  const graph::Previous<graph::Parts<FollowedTools, k_tool_slices>>& last,
                  graph::Slice slice, FollowedTools& followed) noexcept GLINT_NONBLOCKING;

 private:
  void follow_few(const FewMarkers& few, const Tool& shape, const AnchoredHead& anchored, Time time,
                  int place, FollowedTool& tool) noexcept GLINT_NONBLOCKING;

  std::array<RestSums, k_tools_per_slice> sums_;
  graph::LoopCounts counts_;
};

static_assert(graph::Budgeted<FollowMotion, Limits>);

}  // namespace glint
