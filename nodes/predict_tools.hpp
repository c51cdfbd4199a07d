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

// Pose of a tool's marker centroid in its base, with the parts of its covariance.
struct CentroidEstimate {
  MovingPose moving;
  Matrix6 covariance = Matrix6::Zero();  // random part, and of the headset's localisation
  Matrix6 systematic = Matrix6::Zero();  // calibration and correlated errors
  double stamp_s2 = 0;                   // variance of its time stamp
};

// Whether T_world_robot exists, and its value.
[[nodiscard]] bool has_robot_pose(const RobotFrame& robot,
                                  const Estimates& estimates) noexcept GLINT_NONBLOCKING;
[[nodiscard]] Pose robot_in_world(const RobotFrame& robot,
                                  const Estimates& estimates) noexcept GLINT_NONBLOCKING;

// Writes pose, velocities and covariances of the tip into the sample: in the robot's frame, or in
// the base if T_base_robot is null. `robot_covariance`: of T_base_robot, about the robot's base.
void write_tip(const CentroidEstimate& centroid, const Pose* T_base_robot,
               const Matrix6& robot_covariance, const TipPosition& tip,
               PoseSample& sample) noexcept GLINT_NONBLOCKING;

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
