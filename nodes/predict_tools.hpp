// Every tick: each tool's pose at the actuation time, in the robot's frame, with its state.
//
// What:     the motion's mean equations integrated from the newest estimate to the actuation time
//           (kernels/motion/integrate_motion.hpp), their covariance in closed form
//           (predict_motion.hpp); then world -> robot; then from the markers' middle to the tip.
//           The pen's buttons stand in its samples, with or without a pose: who holds one goes on
//           holding it where the camera does not see.
// States:   measured while the newest accepted pose is at most 1.5 nominal frame gaps old,
//           predicted until lost_after, then lost: a contract of the output, so no tuning.
// Cost:     one pass over the tools; those with a pose cost, the others hardly.
// Worst:    all with a pose and expressed in the robot's frame. Where the tool is going makes no
//           difference.
#pragma once

#include <array>
#include <string_view>

#include "graph/graph.hpp"
#include "graph/loops.hpp"
#include "kernels/limits.hpp"
#include "kernels/motion/integrate_motion.hpp"
#include "kernels/nonblocking.hpp"
#include "nodes/tokens.hpp"

namespace glint {

struct PredictSettings {
  Duration nominal_gap = {22'222'222};         // the camera's period: 22.2 ms for AHAT
  Duration lost_after = milliseconds(250);     // at most 400
  Duration actuation_delay = {};               // the pose is for tick + this
  MotionSettings motion;                       // as those that the estimates were followed with
  Matrix6 robot_covariance = Matrix6::Zero();  // of T_world_robot, about its base
  double stamp_sigma_s = 0;                    // of a frame's mid-exposure, beside the frame's own
};

struct PredictTools {
  static constexpr std::array<std::string_view, 3> k_loops = {"call", "tools", "poses"};
  [[nodiscard]] static constexpr graph::LoopCounts worst(const Limits& limits) noexcept {
    return {{1, limits.tools, limits.tools}};
  }
  [[nodiscard]] graph::LoopCounts counts() const noexcept { return counts_; }

  PredictSettings settings;
  Limits limits;
  // The only place that allocates. Reason: not_prepared where SUNDIALS refuses.
  [[nodiscard]] Reason prepare() noexcept { return integrator_.prepare(settings.motion); }
  void operator()(const Now& now, const graph::Latest<Estimates>& estimates,
                  const graph::Latest<RobotFrame>& robot, const graph::Latest<PenButtons>& buttons,
                  PoseSamples& samples) noexcept GLINT_NONBLOCKING;

 private:
  MotionIntegrator integrator_;
  graph::LoopCounts counts_;
};

static_assert(graph::Budgeted<PredictTools, Limits>);

}  // namespace glint
