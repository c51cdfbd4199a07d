// What leaves in place of an activation that was not in time, by the chain's declared policy.
//
// Nothing here asks for the time: frame, tick and what was in time before decide alone, so that a
// replay of the recorded decision gives the same bytes. All rests on what was in time, never on an
// earlier substitute: overruns in a row do not drift.
// Cost:     one pass over k_tools_max tools, each at most one extrapolation.
// Worst:    predict, all tools alive.
// Accuracy: predict is a constant velocity (kernels/motion/interpolate.hpp), hold_last none.
#pragma once

#include "graph/overrun.hpp"
#include "kernels/pose/head_pose.hpp"
#include "nodes/tokens.hpp"

namespace glint {

[[nodiscard]] constexpr Reason reason_of(graph::OverrunPolicy policy) {
  return static_cast<Reason>(static_cast<std::uint8_t>(Reason::overrun_skipped) +
                             static_cast<std::uint8_t>(policy));
}

// The frame that the estimates were not ready for, and the pose of the head then.
struct OverrunFrame {
  FrameStamp stamp;
  HeadPose head;
  Duration lost_after;
};

// The tick that was not in time, and which buttons were held as it was released.
struct OverrunTick {
  Now now;
  Duration lost_after;
  PenButtons buttons;
};

// Frame group. False: nothing is published and the tick group goes on from older estimates.
//   hold_last  each tool stands still where it was last, no longer called measured
//   predict    each tool goes on at its last velocity, no longer called measured
//   stop_safe  each tool is lost until a frame is in time again
[[nodiscard]] bool substitute(graph::OverrunPolicy policy, const OverrunFrame& frame,
                              const Estimates& in_time, Estimates& out) noexcept;

// Tick group. False: nothing leaves at this tick.
//   hold_last  the samples of the last tick that was in time, older by now and predicted
//   predict    the same, moved on to this tick by their velocities
//   stop_safe  each tool is lost at this tick
// Whatever leaves says the buttons of this tick, also without a pose: they were known in time, and
// a button that was let go must not stay held because a pose was late.
[[nodiscard]] bool substitute(graph::OverrunPolicy policy, const OverrunTick& tick,
                              const PoseSamples& in_time, PoseSamples& out) noexcept;

}  // namespace glint
