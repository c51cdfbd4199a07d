// View of a frame's tokens behind the fit, of either tracker graph.
#pragma once

#include <array>

#include "nodes/tracker.hpp"

namespace glint {

// Valid until the tracker's next activation.
struct TrackedFrame {
  const Estimates* estimates = nullptr;
  const Anchor* anchor = nullptr;
  const ToolSet* tools = nullptr;
  std::array<const FittedTools*, k_tool_partitions> fitted{};
  std::array<const FollowedTools*, k_tool_partitions> followed{};
};

// G: Tracker or MarkerTracker.
template <class G>
[[nodiscard]] TrackedFrame tracked_frame(const G& tracker) {
  TrackedFrame frame;
  frame.estimates = &tracker.template output<Estimates>();
  frame.anchor = &tracker.template token<Anchor>();
  frame.tools = &tracker.template token<graph::Latest<ToolSet>>().value();
  for (int i = 0; i < k_tool_partitions; ++i) {
    frame.fitted[static_cast<std::size_t>(i)] = &tracker.template parts<FittedTools>(i);
    frame.followed[static_cast<std::size_t>(i)] = &tracker.template parts<FollowedTools>(i);
  }
  return frame;
}

}  // namespace glint
