// Motion filter of each tool: Kalman filter and static detector of kernels/motion/motion_track.hpp,
// in the frame of the pose: the world if the head pose was valid, else the camera.
//
// If a frame gives no pose but one or two markers (NameFew), these update the filter. The result
// counts as measured only if every axis of the pose is within PrecisionLimits. The same limit holds
// for poses of three and more markers. Beyond it the track continues as predicted and is finally
// lost, however long markers are visible.
//
// The filters are passed as a token, so that an abandoned frame leaves no trace. The sums of the
// static detector stay in the node: a frame writes only entries that the previous frame's state
// does not read. A filter restarts if its slot holds a different tool.
// Cost:   one update of filter and static detector per detected tool, by up to
// k_static_window_levels tests;
//         an update by two markers costs less than one by a pose with its tests.
// Worst:  all tools detected, all static over the whole window length.
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

// Four sigma are then 20 mm or 15 degrees, the experiments' limit of a gross error.
struct PrecisionLimits {
  double position_m = 0.005;
  double rotation_rad = 0.065;
};

// A pose in the camera's frame and its correlated errors, in the frame in which the filter follows:
// the world if the head pose is valid, else the camera.
[[nodiscard]] UncertainPose in_base(const UncertainPose& T_camera_centroid,
                                    const CorrectedHead& corrected_head) noexcept GLINT_NONBLOCKING;
[[nodiscard]] CorrelatedErrors in_base(const CorrelatedErrors& of_camera,
                                       const CorrectedHead& corrected_head) noexcept
    GLINT_NONBLOCKING;

struct FollowMotion {
  static constexpr std::array<std::string_view, 4> k_loops = {"call", "tools", "moved",
                                                              "rest_tests"};
  [[nodiscard]] static constexpr graph::LoopCounts worst(const Limits& limits) noexcept {
    return worst(limits, {0, k_tool_partitions});
  }
  [[nodiscard]] static constexpr graph::LoopCounts worst(const Limits& limits,
                                                         graph::Partition partition) noexcept {
    const std::int64_t tools = tools_of(limits, partition);
    return {{1, tools, tools, tools * k_static_window_levels}};
  }
  [[nodiscard]] graph::LoopCounts counts() const noexcept { return counts_; }

  ToolMotionSettings settings;
  PrecisionLimits precision_limits;
  Limits limits;
  void operator()(const FrameVerdict& verdict, const Anchor& anchor,
                  const graph::Latest<ToolSet>& tools,
                  const graph::Parts<FittedTools, k_tool_partitions>& fitted,
                  const SeenFew& partial,
                  const graph::Previous<graph::Parts<FollowedTools, k_tool_partitions>>& last,
                  graph::Partition partition, FollowedTools& followed) noexcept GLINT_NONBLOCKING;

 private:
  void update_partial(const PartialMarkers& partial, const Tool& shape,
                      const CorrectedHead& corrected_head, Time time, int slot,
                      TrackedTool& tool) noexcept GLINT_NONBLOCKING;

  std::array<StaticWindowSums, k_tools_per_partition> sums_;
  graph::LoopCounts counts_;
};

static_assert(graph::Budgeted<FollowMotion, Limits>);

}  // namespace glint
