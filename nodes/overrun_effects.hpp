// Substitute output for an activation that missed its deadline, by the chain's declared overrun
// policy.
//
// Reads no clock: the result depends only on the frame or tick and the last timely output. A replay
// of the recorded decision therefore gives the same bytes. Substitutes are never derived from
// earlier substitutes, so consecutive overruns do not drift.
// Cost:     one pass over k_tools_max tools, each at most one extrapolation.
// Worst:    predict, all tools alive.
// Accuracy: predict assumes constant velocity (kernels/motion/interpolate.hpp), hold_last no
//           motion.
#pragma once

#include "graph/overrun.hpp"
#include "kernels/pose/head_pose.hpp"
#include "nodes/tokens.hpp"

namespace glint {

[[nodiscard]] constexpr Reason reason_of(graph::OverrunPolicy policy) {
  return static_cast<Reason>(static_cast<std::uint8_t>(Reason::overrun_skipped) +
                             static_cast<std::uint8_t>(policy));
}

// The frame whose estimates missed the deadline, and its head pose.
struct OverrunFrame {
  FrameStamp stamp;
  HeadPose head;
  Duration lost_after;
};

// The tick that missed its deadline, and the buttons held at its release.
struct OverrunTick {
  Now now;
  Duration lost_after;
  PenButtons buttons;
};

// Frame group. Returns false if nothing is published; the tick group then uses older estimates.
//   hold_last  each tool stays at its last pose, no longer `measured`
//   predict    each tool continues at its last velocity, no longer `measured`
//   stop_safe  each tool is lost until a frame meets its deadline again
[[nodiscard]] bool substitute(graph::OverrunPolicy policy, const OverrunFrame& frame,
                              const Estimates& timely, Estimates& out) noexcept;

// Tick group. Returns false if nothing is published at this tick.
//   hold_last  the samples of the last timely tick, with their present age, as `predicted`
//   predict    the same, extrapolated to this tick by their velocities
//   stop_safe  each tool is lost at this tick
// All samples carry the buttons of this tick, also without a pose: these were received in time. A
// released button must not stay held because a pose was late.
[[nodiscard]] bool substitute(graph::OverrunPolicy policy, const OverrunTick& tick,
                              const PoseSamples& timely, PoseSamples& out) noexcept;

}  // namespace glint
