// Track management: keeps each tool's newest pose, the previous one and their validity between
// frames. Poses are stored in the world if the head pose was valid, because the head's motion does
// not disturb the pen's there; otherwise in the camera frame.
// Cost: one pass over the tools. Worst input: all found, with a valid head pose.
#pragma once

#include <array>
#include <string_view>

#include "graph/graph.hpp"
#include "kernels/nonblocking.hpp"
#include "kernels/pose/tool.hpp"
#include "nodes/node_limits.hpp"
#include "nodes/tokens.hpp"

namespace glint {

struct TrackSettings {
  Duration lost_after = milliseconds(250);
  // Two poses with a longer gap give no velocity for extrapolation.
  Duration velocity_gap_max = milliseconds(120);
};

struct TrackTools {
  static constexpr std::array<std::string_view, 3> k_loops = {"call", "tools", "found"};
  [[nodiscard]] static constexpr graph::LoopCounts worst(const Limits& limits) noexcept {
    return {{1, limits.tools, limits.tools}};
  }
  [[nodiscard]] graph::LoopCounts counts() const noexcept { return counts_; }

  TrackSettings settings;
  MarkerNoise noise;  // declared: initial value of the estimate
  bool estimate_noise = true;
  Limits limits;
  void operator()(const FrameVerdict& verdict, const Anchor& anchor,
                  const graph::Latest<ToolSet>& tools,
                  const graph::Parts<FittedTools, k_tool_partitions>& fitted,
                  const graph::Parts<FollowedTools, k_tool_partitions>& followed,
                  const graph::Previous<Estimates>& last,
                  Estimates& estimates) noexcept GLINT_NONBLOCKING;

 private:
  graph::LoopCounts counts_;
};

static_assert(graph::Budgeted<TrackTools, Limits>);

// Covariance of a frame's published pose (the fit's or the filter's), systematic part included: of
// the tip, about the camera's axes.
[[nodiscard]] Matrix6 tip_covariance(const Track& track, const FittedTool& found,
                                     const TipPosition& tip) noexcept;

}  // namespace glint
