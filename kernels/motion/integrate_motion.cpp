#include "kernels/motion/integrate_motion.hpp"

#include <arkode/arkode_erkstep.h>

#include <new>

#include "kernels/elementary.hpp"
#include "kernels/motion/state_vector.hpp"

namespace glint {
namespace {

// Position, velocity; quaternion (x, y, z, w), angular velocity. The accelerations are explicit
// functions of time.
constexpr int k_size = 13;
using State = StateVector<k_size>;
using Values = State::Values;

struct Drive {
  double linear_damping = 0, angular_damping = 0;
  Vector3 acceleration = Vector3::Zero(), angular_acceleration = Vector3::Zero();
};

int motion(double seconds, N_Vector y, N_Vector derivative, void* user_data) {
  const Drive& drive = *static_cast<const Drive*>(user_data);
  const Values& s = State::of(y);
  Values& d = State::of(derivative);
  const double linear_decay = exponential(-drive.linear_damping * seconds);
  const double angular_decay = exponential(-drive.angular_damping * seconds);
  for (std::size_t i = 0; i < 3; ++i) {
    const auto axis = static_cast<Eigen::Index>(i);
    d[i] = s[i + 3];
    d[i + 3] = linear_decay * drive.acceleration(axis);
    d[i + 10] = angular_decay * drive.angular_acceleration(axis);
  }
  const double qx = s[6], qy = s[7], qz = s[8], qw = s[9];
  const double wx = 0.5 * s[10], wy = 0.5 * s[11], wz = 0.5 * s[12];
  d[6] = wx * qw + wy * qz - wz * qy;
  d[7] = wy * qw + wz * qx - wx * qz;
  d[8] = wz * qw + wx * qy - wy * qx;
  d[9] = -(wx * qx + wy * qy + wz * qz);
  return 0;
}

void fill(const MotionState& state, Values& values) {
  Eigen::Map<Eigen::Matrix<double, k_size, 1>> y(values.data());
  y << state.pose.translation, state.velocity_m_s, state.pose.rotation.coeffs(),
      state.angular_velocity_rad_s;
}

// Suppresses SUNDIALS' messages on the terminal: errors are return values here.
void ignore(int, const char*, const char*, char*, void*) {}

bool set_method(void* memory) {
  double c[4] = {0, 0.5, 0.5, 1};
  double a[16] = {0, 0, 0, 0, 0.5, 0, 0, 0, 0, 0.5, 0, 0, 0, 0, 1, 0};
  double b[4] = {1.0 / 6, 1.0 / 3, 1.0 / 3, 1.0 / 6};
  ARKodeButcherTable table = ARKodeButcherTable_Create(4, 4, 0, c, a, b, nullptr);
  if (table == nullptr) return false;
  const bool set = ERKStepSetTable(memory, table) == ARK_SUCCESS;
  ARKodeButcherTable_Free(table);
  return set;
}

}  // namespace

struct MotionIntegrator::Workspace {
  SUNContext context = nullptr;
  N_Vector state = nullptr;
  void* memory = nullptr;
  Drive drive;

  // Takes all equal steps from `start`; returns false if SUNDIALS fails. The first call allocates:
  // prepare() makes it, and the real-time path calls only a prepared workspace.
  bool integrate(const MotionState& start, Duration ahead) noexcept;
};

bool MotionIntegrator::Workspace::integrate(const MotionState& start, Duration ahead) noexcept {
  fill(start, State::of(state));
  drive.acceleration = start.acceleration_m_s2;
  drive.angular_acceleration = start.angular_acceleration_rad_s2;
  const double step = ahead.seconds() / k_integration_steps;
  bool done = ERKStepReset(memory, 0, state) == ARK_SUCCESS &&
              ERKStepSetFixedStep(memory, step) == ARK_SUCCESS;
  double reached = 0;
  for (int i = 0; i < k_integration_steps && done; ++i)
    done = ERKStepEvolve(memory, ahead.seconds(), state, &reached, ARK_ONE_STEP) >= 0;
  return done;
}

void MotionIntegrator::Free::operator()(Workspace* workspace) const noexcept {
  if (workspace->memory != nullptr) ERKStepFree(&workspace->memory);
  if (workspace->state != nullptr) N_VDestroy(workspace->state);
  if (workspace->context != nullptr) SUNContext_Free(&workspace->context);
  delete workspace;
}

MotionIntegrator::MotionIntegrator() noexcept = default;
MotionIntegrator::~MotionIntegrator() = default;
MotionIntegrator::MotionIntegrator(MotionIntegrator&&) noexcept = default;
MotionIntegrator& MotionIntegrator::operator=(MotionIntegrator&&) noexcept = default;

Reason MotionIntegrator::prepare(const MotionSettings& settings) noexcept {
  workspace_.reset(new (std::nothrow) Workspace);
  if (!workspace_) return Reason::not_prepared;
  Workspace& w = *workspace_;
  w.drive.linear_damping = settings.linear_damping_1_s;
  w.drive.angular_damping = settings.angular_damping_1_s;
  bool made = SUNContext_Create(nullptr, &w.context) == 0;
  made = made && (w.state = State::make(w.context)) != nullptr;
  made = made && (w.memory = ERKStepCreate(motion, 0, w.state, w.context)) != nullptr;
  made = made && ERKStepSetErrHandlerFn(w.memory, ignore, nullptr) == ARK_SUCCESS;
  made = made && ERKStepSetUserData(w.memory, &w.drive) == ARK_SUCCESS;
  // The Lagrange interpolant only stores old states; Hermite's needs one more evaluation a step.
  made = made && ERKStepSetInterpolantType(w.memory, ARK_INTERP_LAGRANGE) == ARK_SUCCESS;
  made = made && ERKStepSetInterpolantDegree(w.memory, 1) == ARK_SUCCESS;
  made = made && set_method(w.memory);
  made = made && w.integrate(MotionState{}, milliseconds(1));
  if (made) return Reason::none;
  workspace_.reset();
  return Reason::not_prepared;
}

// SUNDIALS declares no function effects. integrate_motion_test.cpp and SUNDIALS' source show that
// it allocates no memory here and reads no clock.
#if defined(__clang__) && defined(__has_warning)
#if __has_warning("-Wfunction-effects")
#pragma clang diagnostic push
#pragma clang diagnostic ignored "-Wfunction-effects"
#define GLINT_EFFECTS_IGNORED
#endif
#endif
Result<MovingPose> MotionIntegrator::after(const MotionState& state, Duration ahead) noexcept {
  const MovingPose now{state.pose, state.velocity_m_s, state.angular_velocity_rad_s};
  if (!workspace_) return {now, Reason::not_prepared};
  if (ahead <= Duration{}) return {now, Reason::none};
  if (!workspace_->integrate(state, ahead)) return {now, Reason::not_prepared};
  const Values& y = State::of(workspace_->state);
  MovingPose later;
  later.pose = {Quaternion(y[9], y[6], y[7], y[8]).normalized(), Vector3(y[0], y[1], y[2])};
  later.velocity_m_s = {y[3], y[4], y[5]};
  later.angular_velocity_rad_s = {y[10], y[11], y[12]};
  return {later, Reason::none};
}
#ifdef GLINT_EFFECTS_IGNORED
#pragma clang diagnostic pop
#endif

}  // namespace glint
