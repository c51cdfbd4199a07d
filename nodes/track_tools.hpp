// Keeps what is known of each tool between frames: its newest pose, the one before, and until when
// either may be used. The poses are kept in the world where the headset knew its own pose, because
// there the head's motion does not disturb the pen's; otherwise in the camera's frame.
// Cost: one pass over k_tools_max tools. Worst input: all found.
#pragma once

#include "graph/graph.hpp"
#include "kernels/pose/head_pose.hpp"
#include "kernels/pose/tool.hpp"
#include "nodes/tokens.hpp"

namespace glint {

struct TrackSettings {
  Duration lost_after = milliseconds(250);
  // Two poses further apart than this give no velocity worth extrapolating.
  Duration velocity_gap_max = milliseconds(120);
};

struct TrackTools {
  TrackSettings settings;
  void operator()(const FrameVerdict& verdict, const HeadPose& head,
                  const graph::Latest<ToolSet>& tools, const graph::Parts<FittedTools, 2>& fitted,
                  const graph::Previous<Estimates>& last, Estimates& estimates) const noexcept;
};

}  // namespace glint
