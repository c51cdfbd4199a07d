// Pose prediction at each tick: each tool's pose at the actuation time, in the robot's frame, with
// its tracking state.
//
// What:     the mean of the motion model integrated from the newest estimate to the actuation time
//           (kernels/motion/integrate_motion.hpp), its covariance in closed form
//           (predict_motion.hpp); then world -> robot; then marker centroid -> tip. The pen's
//           samples carry its buttons, with or without a pose: a held button stays held outside the
//           camera's view.
// States:   `measured` while the newest accepted pose is at most 1.5 nominal frame gaps old,
//           `predicted` until lost_after, then `lost`. This is an output contract, not tunable.
// Cost:     one pass over the tools; tools without a pose cost little.
// Worst:    all tools with a pose and expressed in the robot's frame; independent of the motion.
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
  Duration actuation_delay = {};               // the pose is for tick + actuation_delay
  MotionSettings motion;                       // as used by the motion filter
  Matrix6 robot_covariance = Matrix6::Zero();  // of T_world_robot, about its base
  double stamp_sigma_s = 0;  // standard deviation of mid-exposure, beside the frame's own
};

struct PredictTools {
  static constexpr std::array<std::string_view, 3> k_loops = {"call", "tools", "poses"};
  [[nodiscard]] static constexpr graph::LoopCounts worst(const Limits& limits) noexcept {
    return {{1, limits.tools, limits.tools}};
  }
  [[nodiscard]] graph::LoopCounts counts() const noexcept { return counts_; }

  PredictSettings settings;
  Limits limits;
  // The only function that allocates. Returns not_prepared if SUNDIALS fails.
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
