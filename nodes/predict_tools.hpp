// Every tick: each tool's pose at the actuation time, in the robot's frame, with its state.
//
// What:     constant velocity for the position, SLERP for the orientation (Shoemake 1985), both
//           from the last two measured poses; then world -> robot; then the tip.
// States:   measured while the newest accepted pose is at most 1.5 nominal frame gaps old,
//           predicted until lost_after, then lost: DESIGN contract, so no tuning.
// Cost:     one pass over the tools; those with a pose cost, the others hardly.
// Worst:    all moving, predicted and expressed in the robot's frame.
#pragma once

#include <array>
#include <string_view>

#include "graph/graph.hpp"
#include "graph/loops.hpp"
#include "kernels/limits.hpp"
#include "kernels/nonblocking.hpp"
#include "nodes/tokens.hpp"

namespace glint {

struct PredictSettings {
  Duration nominal_gap = {22'222'222};      // the camera's period: 22.2 ms for AHAT
  Duration lost_after = milliseconds(250);  // at most 400
  Duration actuation_delay = {};            // the pose is for tick + this
};

struct PredictTools {
  static constexpr std::array<std::string_view, 4> k_loops = {"call", "tools", "poses", "moving"};
  [[nodiscard]] static constexpr graph::LoopCounts worst(const Limits& limits) noexcept {
    return {{1, limits.tools, limits.tools, limits.tools}};
  }
  [[nodiscard]] graph::LoopCounts counts() const noexcept { return counts_; }

  PredictSettings settings;
  Limits limits;
  void operator()(const Now& now, const graph::Latest<Estimates>& estimates,
                  const graph::Latest<RobotFrame>& robot,
                  PoseSamples& samples) noexcept GLINT_NONBLOCKING;

 private:
  graph::LoopCounts counts_;
};

static_assert(graph::Budgeted<PredictTools, Limits>);

}  // namespace glint
