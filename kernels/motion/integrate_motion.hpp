// Numerical prediction of a tool's pose: Runge-Kutta integration of its equations of motion.
//
// What:     p' = v, v' = a exp(-c t); q' = w q / 2, w' = b exp(-d t) (fixed axes), by the classical
//           fourth-order method in k_integration_steps equal steps of SUNDIALS' ERKStep.
// Cost:     always the same steps, 4 evaluations each: 5 us.
// Worst:    data independent. Unprepared: Reason::not_prepared.
// Accuracy: against CVODE at 1e-12, hand-held speeds (3 rad/s): 2e-7 rad after 50 ms, 1e-4 after
//           250 ms; large damping is not stiff, because it is a function of time, not feedback.
// Source:   Kutta 1901 (the method); Reynolds et al. 2023, ARKODE, ACM Transactions on Mathematical
//           Software 49(2); quaternion kinematics: Sola 2017, Quaternion kinematics for the
//           error-state Kalman filter, section 1.5.
#pragma once

#include <memory>

#include "kernels/motion/motion_filter.hpp"
#include "kernels/motion/motion_state.hpp"
#include "kernels/nonblocking.hpp"
#include "kernels/result.hpp"

namespace glint {

inline constexpr int k_integration_steps = 4;

struct MovingPose {
  Pose pose;
  Vector3 velocity_m_s = Vector3::Zero();
  Vector3 angular_velocity_rad_s = Vector3::Zero();
};

class MotionIntegrator {
 public:
  MotionIntegrator() noexcept;
  ~MotionIntegrator();
  MotionIntegrator(MotionIntegrator&&) noexcept;
  MotionIntegrator& operator=(MotionIntegrator&&) noexcept;

  // The only function that allocates. Its last action is an integration, because ERKStep allocates
  // in its first step. Returns not_prepared if a SUNDIALS call fails.
  [[nodiscard]] Reason prepare(const MotionSettings& settings) noexcept;

  // Pose and velocities `ahead` of the state's time; the state's own if `ahead` is not positive.
  [[nodiscard]] Result<MovingPose> after(const MotionState& state,
                                         Duration ahead) noexcept GLINT_NONBLOCKING;

 private:
  struct Workspace;
  struct Free {
    void operator()(Workspace* workspace) const noexcept;
  };
  std::unique_ptr<Workspace, Free> workspace_;
};

}  // namespace glint
