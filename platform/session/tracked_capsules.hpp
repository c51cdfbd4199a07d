// Where the tracked tools and the hands that hold them are, so that they stay out of the map.
#pragma once

#include "kernels/cloud/leave_out_capsules.hpp"
#include "nodes/tokens.hpp"

namespace glint {

// About a tool's line from its tip through its markers' middle, and the hand behind them.
inline constexpr double k_held_radius_m = 0.08, k_held_behind_m = 0.15;

struct TrackedCapsules {
  std::array<LeftOut, k_tools_max> items;  // in the world
  int count = 0;
  [[nodiscard]] std::span<const LeftOut> all() const {
    return std::span(items).first(static_cast<std::size_t>(count));
  }
};

// Of the tools that are tracked in the world.
[[nodiscard]] inline TrackedCapsules capsules_of(const Estimates& estimates) {
  TrackedCapsules out;
  for (int t = 0; t < estimates.tool_count; ++t) {
    const auto at = static_cast<std::size_t>(t);
    const Track& track = estimates.tracks[at];
    if (!track.alive || track.base != ReferenceFrame::world) continue;
    const Pose& T_world_middle = track.motion.pose;
    const Vector3 arm = T_world_middle.rotation * estimates.arm_m[at];
    const double length = arm.norm();
    const Vector3 back = length > 0 ? Vector3(arm * (-k_held_behind_m / length)) : Vector3::Zero();
    const Vector3& middle = T_world_middle.translation;
    out.items[static_cast<std::size_t>(out.count++)] = {middle + arm, middle + back,
                                                        k_held_radius_m};
  }
  return out;
}

}  // namespace glint
