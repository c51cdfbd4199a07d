// Every tick: each tool's pose at the actuation time, in the robot's frame, with its state.
//
// What:     constant velocity for the position, SLERP for the orientation (Shoemake 1985), both
//           from the last two measured poses; then world -> robot; then the tip.
// States:   measured while the newest accepted pose is at most 1.5 nominal frame gaps old,
//           predicted until lost_after, then lost: DESIGN contract, so no tuning.
// Cost:     one pass over k_tools_max tools. Worst input: all predicted.
#pragma once

#include "graph/graph.hpp"
#include "nodes/tokens.hpp"

namespace glint {

struct PredictSettings {
  Duration nominal_gap = {22'222'222};      // the camera's period: 22.2 ms for AHAT
  Duration lost_after = milliseconds(250);  // at most 400
  Duration actuation_delay = {};            // the pose is for tick + this
};

struct PredictTools {
  PredictSettings settings;
  void operator()(const Now& now, const graph::Latest<Estimates>& estimates,
                  const graph::Latest<RobotFrame>& robot, PoseSamples& samples) const noexcept;
};

}  // namespace glint
